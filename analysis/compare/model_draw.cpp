#include "analysis/compare/model_draw.hpp"

#include <algorithm>

#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog {

namespace {

using Uncertainties = std::map<std::string, double>;

double uncertainty(const Uncertainties& of, const char* name) {
    const auto found = of.find(name);
    return found == of.end() ? 0.0 : found->second;
}

}  // namespace

SensorModel draw_within_uncertainty(const SensorModel& model, std::uint64_t seed) {
    SensorModel drawn = model;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const RandomStream random = derived_stream(seed, RandomPurpose::noise_coefficients, axis);
        const Uncertainties& own = model.axes[axis].sd_rel;
        std::uint64_t next = 0;
        const auto vary = [&](const char* name, double& coefficient) {
            const double sd = own.contains(name) ? own.at(name) : uncertainty(model.sd_rel, name);
            coefficient *= std::max(0.0, 1.0 + sd * random.normal(next++));
        };
        NoiseCoefficients& noise = drawn.axes[axis].noise;
        vary("Q", noise.Q_rad);
        vary("N", noise.N_rad_per_sqrt_s);
        vary("B", noise.B_rad_per_s);
        vary("K", noise.K_rad_per_s_sqrt_s);
        vary("R", noise.R_rad_per_s2);
    }
    const RandomStream random = derived_stream(seed, RandomPurpose::sensor_parameters);
    std::uint64_t next = 0;
    drawn.timestamp_jitter_s *=
        std::max(0.0, 1.0 + uncertainty(model.sd_rel, "timestamp_jitter") * random.normal(next++));
    drawn.latency_s += uncertainty(model.sd_abs, "latency_s") * random.normal(next++);
    for (Vector3& row : drawn.M) {
        for (double& gain : row) { gain += uncertainty(model.sd_abs, "M") * random.normal(next++); }
    }
    return drawn;
}

}  // namespace gyrolog
