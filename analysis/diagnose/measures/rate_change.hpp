// What is left of a moving sensor against the change of the model's answer: the mean of the whitened samples
// by it, in ranges of as many samples each, in standard deviations; and over time their product with it, in
// standard deviations, which shows where the delay is off. x is in rad/s^2, or in s.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure acceleration;
extern const Measure delay_course;
}  // namespace measures

// A sensor at rest has none.
void add_rate_change_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
