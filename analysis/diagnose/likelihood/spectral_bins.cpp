#include "analysis/diagnose/likelihood/spectral_bins.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog::resolution {

constexpr std::size_t single_bins = 48;
// Afterwards a bin is this part of its frequency wide: 3 %, over which no density of interest bends.
constexpr std::size_t bins_per_frequency = 32;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

std::size_t coefficients_of(Half half, std::size_t first, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t k = first; k < end; ++k) { count += has_coefficient(half, k) ? 1U : 0U; }
    return count;
}

}  // namespace

SpectralBins spectral_bins(std::size_t length, double rate_hz, Half half) {
    SpectralBins bins;
    const double step_hz = rate_hz / (2.0 * static_cast<double>(length));
    for (std::size_t first = 1; first < length;) {
        const std::size_t width = first < resolution::single_bins
                                      ? 1
                                      : std::max<std::size_t>(1, first / resolution::bins_per_frequency);
        const std::size_t end = std::min(length, first + width);
        const double f_hz = step_hz * std::sqrt(static_cast<double>(first) * static_cast<double>(end - 1));
        const std::size_t count = coefficients_of(half, first, end);
        if (count > 0) { bins.push_back({first, end, f_hz, half, static_cast<double>(count)}); }
        first = end;
    }
    return bins;
}

}  // namespace gyrolog
