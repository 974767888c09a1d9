// The spectrum: the mean ratio r of power to fitted density in thirds of octaves, as 3 (r^(1/3) - 1), over
// frequency in Hz. The cube root of a chi-square is nearly normal, the logarithm of one with one degree of
// freedom is not (E. B. Wilson, M. M. Hilferty, PNAS 17 (1931) 684).
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure spectrum;
}

void add_spectrum_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
