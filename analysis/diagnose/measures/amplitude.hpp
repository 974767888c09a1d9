// Tails: the number n of whitened samples beyond x standard deviations, as 2 sqrt(n + 3/8), whose variance is
// 1 (F. J. Anscombe, Biometrika 35 (1948) 246). Skewness: the sum of the samples' cubes over its standard
// deviation sqrt(15 n), one number that has no place among the sizes.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure amplitude;
extern const Measure skewness;
}  // namespace measures

// Means of samples have no such curves: how samples are distributed they do not tell.
void add_amplitude_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
