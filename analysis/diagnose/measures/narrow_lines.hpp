// Narrow lines: in each band of the spectrum, the largest sum of whitened power over 4 to 256 neighbouring
// cosine coefficients, as the normal deviate that chance exceeds as rarely; over 2 to 16 below the bands that
// hold the broadest of them. x is the frequency of the sum's middle, in Hz.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure narrow;
}

void add_narrow_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
