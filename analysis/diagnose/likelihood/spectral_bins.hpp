// The cosine coefficients of a record gathered by frequency.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/half.hpp"

namespace gyrolog {

// Coefficients first ... end - 1, those of them that the half has; one each at low frequencies, then a share
// of an octave.
struct SpectralBin {
    std::size_t first = 1;
    std::size_t end = 2;
    double f_hz = 0.0;  // geometric middle
    Half half = Half::both;
    double number = 1.0;

    bool has(std::size_t k) const { return has_coefficient(half, k); }
    double count() const { return number; }
};
using SpectralBins = std::vector<SpectralBin>;

// None is empty.
SpectralBins spectral_bins(std::size_t length, double rate_hz, Half half = Half::both);

}  // namespace gyrolog
