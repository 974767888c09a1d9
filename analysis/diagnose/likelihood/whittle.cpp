#include "analysis/diagnose/likelihood/whittle.hpp"

#include <cmath>

namespace gyrolog {

double whittle_log_likelihood_nats(const SpectralBins& bins, std::span<const double> power,
                                   std::span<const double> density) {
    double nats = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        nats -= 0.5 * bins[i].count() * (std::log(density[i]) + power[i] / density[i]);
    }
    return nats;
}

}  // namespace gyrolog
