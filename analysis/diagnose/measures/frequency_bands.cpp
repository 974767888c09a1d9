#include "analysis/diagnose/measures/frequency_bands.hpp"

#include <cmath>

namespace gyrolog::resolution {

constexpr double bands_per_octave = 3.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

std::vector<std::size_t> band_edges(const SpectralBins& bins) {
    std::vector<std::size_t> edges;
    double next_hz = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        if (bins[i].f_hz < next_hz) { continue; }
        edges.push_back(i);
        next_hz = bins[i].f_hz * std::exp2(1.0 / resolution::bands_per_octave) * 0.999;
    }
    edges.push_back(bins.size());
    return edges;
}

}  // namespace gyrolog
