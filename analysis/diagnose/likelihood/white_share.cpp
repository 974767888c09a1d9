#include "analysis/diagnose/likelihood/white_share.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

WhiteShare white_share(const Prediction& prediction, std::size_t axis) {
    double count = 0.0;
    double variance = 0.0;
    double amplitude = 0.0;
    double gain = 0.0;
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        const double n = prediction.bins()[i].count();
        const SpectralParts& parts = prediction.parts(axis)[i];
        const double density = parts.sum();
        if (!(density > 0.0)) { continue; }
        count += n;
        variance += n * parts.white / density;
        amplitude += n * std::sqrt(parts.white / density);
        gain += n / std::sqrt(density * prediction.rate_hz());
    }
    WhiteShare share;
    if (count == 0.0) { return share; }
    share.variance = variance / count;
    share.own_variance = amplitude * amplitude / (count * count);
    share.lattice = prediction.model().lsb_rad_s * gain / count;
    return share;
}

double whitened_per_rad_s(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const std::vector<double>& density = observation.axis(axis).density;
    double count = 0.0;
    double gain = 0.0;
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        if (!(density[i] > 0.0)) { continue; }
        count += prediction.bins()[i].count();
        gain += prediction.bins()[i].count() / std::sqrt(density[i] * prediction.rate_hz());
    }
    return count > 0.0 ? gain / count : 0.0;
}

double level_cost_nats(const Observation& observation, std::size_t axis, double level) {
    const Prediction& prediction = observation.prediction();
    const double sd = noise_uncertainty(prediction.model(), axis)[0];
    const double of_model = (1.0 + sd * observation.axis(axis).noise.z[0]) * level;
    // n samples know a standard deviation to 1 / sqrt(2 n) of it.
    const double known = 1.0 / (2.0 * static_cast<double>(prediction.length()));
    return 0.5 * (of_model - 1.0) * (of_model - 1.0) / (sd * sd + known);
}

}  // namespace gyrolog
