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

SpectralBins spectral_bins(std::size_t length, double rate_hz, Half half, std::span<const std::size_t> cuts) {
    SpectralBins bins;
    const double step_hz = rate_hz / (2.0 * static_cast<double>(length));
    auto cut = cuts.begin();
    for (std::size_t uncut_first = 1; uncut_first < length;) {
        const std::size_t width =
            uncut_first < resolution::single_bins
                ? 1
                : std::max<std::size_t>(1, uncut_first / resolution::bins_per_frequency);
        const std::size_t uncut_end = std::min(length, uncut_first + width);
        for (std::size_t first = uncut_first; first < uncut_end;) {
            while (cut != cuts.end() && *cut <= first) { ++cut; }
            const std::size_t end = cut == cuts.end() ? uncut_end : std::min(*cut, uncut_end);
            const double f_hz =
                step_hz * std::sqrt(static_cast<double>(first) * static_cast<double>(end - 1));
            const std::size_t count = coefficients_of(half, first, end);
            if (count > 0) {
                bins.push_back({first, end, f_hz, half, static_cast<double>(count), uncut_first});
            }
            first = end;
        }
        uncut_first = uncut_end;
    }
    return bins;
}

double mean_density(const SpectralBins& bins, std::span<const double> density) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        sum += bins[i].count() * density[i];
        count += bins[i].count();
    }
    return sum / count;
}

}  // namespace gyrolog
