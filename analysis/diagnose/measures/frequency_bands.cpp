#include "analysis/diagnose/measures/frequency_bands.hpp"

#include <cmath>

namespace gyrolog::resolution {

constexpr double bands_per_octave = 3.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

double middle_hz(const SpectralBins& bins, std::size_t first, std::size_t end) {
    const auto coefficient = [](std::size_t from, std::size_t to) {
        return std::sqrt(static_cast<double>(from) * static_cast<double>(to - 1));
    };
    const double step_hz = bins[first].f_hz / coefficient(bins[first].first, bins[first].end);
    return step_hz * coefficient(bins[first].first, bins[end - 1].end);
}

// By whole bins, so that cuts move no band.
std::vector<std::size_t> band_edges(const SpectralBins& bins) {
    std::vector<std::size_t> edges;
    double next_hz = 0.0;
    for (std::size_t i = 0; i < bins.size();) {
        std::size_t end = i + 1;
        while (end < bins.size() && bins[end].uncut_first == bins[i].uncut_first) { ++end; }
        const double f_hz = middle_hz(bins, i, end);
        if (f_hz >= next_hz) {
            edges.push_back(i);
            next_hz = f_hz * std::exp2(1.0 / resolution::bands_per_octave) * 0.999;
        }
        i = end;
    }
    edges.push_back(bins.size());
    return edges;
}

}  // namespace gyrolog
