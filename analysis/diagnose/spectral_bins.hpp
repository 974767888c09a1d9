// The cosine coefficients of a record gathered by frequency.
#pragma once

#include <cstddef>
#include <vector>

namespace gyrolog {

// Coefficients first ... end - 1; one each at low frequencies, then a share of an octave.
struct SpectralBin {
    std::size_t first = 1;
    std::size_t end = 2;
    double f_hz = 0.0;  // geometric middle

    double count() const { return static_cast<double>(end - first); }
};
using SpectralBins = std::vector<SpectralBin>;

SpectralBins spectral_bins(std::size_t length, double rate_hz);

}  // namespace gyrolog
