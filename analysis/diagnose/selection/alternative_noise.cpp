#include "analysis/diagnose/selection/alternative_noise.hpp"

#include <cmath>

namespace gyrolog {

AlternativeNoise alternative_noise(const Observation& without, const Observation& with, std::size_t axis) {
    const Prediction& prediction = without.prediction();
    const SpectralBins& bins = prediction.bins();
    const AxisObservation& seen = without.axis(axis);
    AlternativeNoise noise;
    noise.density.resize(bins.size());
    expected_density(prediction.parts(axis), noise_uncertainty(prediction.model(), axis),
                     with.axis(axis).noise.z, noise.density);
    double log_likelihood_nats = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        log_likelihood_nats -=
            0.5 * bins[i].count() * (std::log(noise.density[i]) + seen.power[i] / noise.density[i]);
    }
    for (const double z : with.axis(axis).noise.z) { log_likelihood_nats -= 0.5 * z * z; }
    noise.lost_nats = seen.noise.log_likelihood_nats - log_likelihood_nats;
    return noise;
}

}  // namespace gyrolog
