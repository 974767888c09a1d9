#include "analysis/diagnose/selection/alternative_noise.hpp"

#include "analysis/diagnose/likelihood/whittle.hpp"

namespace gyrolog {

AlternativeNoise alternative_noise(const Observation& without, const Observation& with, std::size_t axis) {
    const Prediction& prediction = without.prediction();
    const SpectralBins& bins = prediction.bins();
    const AxisObservation& seen = without.axis(axis);
    AlternativeNoise noise;
    noise.density.resize(bins.size());
    expected_density(prediction.parts(axis), noise_uncertainty(prediction.model(), axis),
                     with.axis(axis).noise.z, noise.density);
    double log_likelihood_nats = whittle_log_likelihood_nats(bins, seen.power, noise.density);
    for (const double z : with.axis(axis).noise.z) { log_likelihood_nats -= 0.5 * z * z; }
    noise.lost_nats = seen.noise.log_likelihood_nats - log_likelihood_nats;
    return noise;
}

}  // namespace gyrolog
