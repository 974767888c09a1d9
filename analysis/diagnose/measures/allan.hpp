// The Allan deviation of the residual, ln of it over averaging times that double, in rad/s (IEEE Std
// 952-1997, C.1, with overlapping averages). Eight places within one averaging time are used: they tell
// nearly as much as all.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure allan;
}

void add_allan_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
