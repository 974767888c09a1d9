// The mean of the whitened samples by temperature, in standard deviations. x is in degC.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure temperature;
}

// There is no curve where the temperature does not vary.
void add_temperature_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
