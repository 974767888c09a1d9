// Tails: the number n of whitened samples beyond x standard deviations, as 2 sqrt(n + 3/8), whose variance is
// 1 (F. J. Anscombe, Biometrika 35 (1948) 246). The last point, at x = 0, is none of them: it is the samples'
// skewness.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure amplitude;
}

// Means of samples have no such curve: how samples are distributed they do not tell.
void add_amplitude_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
