// Repeated samples: how often a sample equals the one or two before, beyond how often it equals those before
// them, in standard deviations. x is the lag in s.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure repeats;
}

// Means of samples have no such curve: means of codes are equal now and then, those of a simulation never.
void add_repeats_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
