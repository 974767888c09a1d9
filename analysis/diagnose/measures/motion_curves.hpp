// What is left of a moving sensor against its motion.
#pragma once

#include <vector>

#include "analysis/diagnose/measures/gap_curves.hpp"

namespace gyrolog {

//   rate          mean of the whitened samples by reference rate, about each axis that turns
//   rate_noise    ln of their variance by its own rate
//   acceleration  mean of the whitened samples by change of the model's answer, as many samples in
//                 every range
//   gain_course   over time, the whitened samples' product with the true rate, in standard deviations
//   delay_course  the same with the change of the model's answer
std::vector<GapCurve> motion_curves(const Observation& observation, std::size_t axis);

// Mean of the whitened samples by temperature.
GapCurve temperature_curve(const Observation& observation, std::size_t axis);

bool varies(const std::vector<float>& values);

}  // namespace gyrolog
