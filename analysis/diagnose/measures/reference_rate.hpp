// What is left of a moving sensor against the reference rate: the mean of the whitened samples by the rate
// about each axis that turns, in standard deviations; ln of their variance by the rate about their own axis;
// and over time their product with that rate, in standard deviations, which shows where the gain is off. x is
// in rad/s, or in s.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure rate;
extern const Measure rate_noise;
extern const Measure gain_course;
}  // namespace measures

// A sensor at rest has none.
void add_reference_rate_curves(const Observation& observation, std::size_t axis,
                               std::vector<GapCurve>& curves);

}  // namespace gyrolog
