#include "analysis/diagnose/swallowed_noise.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace gyrolog {

namespace {

// Two coefficients of an axis may go down; by chance they earn this in one recording of some hundred.
constexpr double called_for_nats = 5.0;
// From nothing to some three times the stated value.
constexpr double free_sd_rel = 0.9;

constexpr std::array<char, 3> names = {'N', 'B', 'K'};

double& coefficient_of(NoiseCoefficients& noise, std::size_t index) {
    return *std::array{&noise.N_rad_per_sqrt_s, &noise.B_rad_per_s, &noise.K_rad_per_s_sqrt_s}.at(index);
}

bool has_swallowed_noise(const Observation& observation, std::size_t axis) {
    const Baseline& baseline = observation.baseline();
    const AxisObservation& seen = observation.axis(axis);
    const std::array<double, 3> stated = noise_uncertainty(baseline.model(), axis);
    std::array<double, 3> sd_rel = {stated[0], free_sd_rel, free_sd_rel};
    const auto fit = [&] { return fit_nuisance(baseline.bins(), baseline.parts(axis), seen.power, sd_rel); };
    NoiseNuisance freed = fit();
    for (const std::size_t index : {std::size_t{1}, std::size_t{2}}) {
        // More noise than stated has names of its own among the effects.
        if (freed.z[index] < 0.0) { continue; }
        sd_rel[index] = stated[index];
        freed = fit();
    }
    return freed.log_likelihood_nats - seen.noise.log_likelihood_nats > called_for_nats;
}

}  // namespace

std::vector<std::size_t> axes_with_swallowed_noise(const Observation& observation) {
    std::vector<std::size_t> axes = observation.baseline().axes();
    std::erase_if(axes, [&](std::size_t axis) { return !has_swallowed_noise(observation, axis); });
    return axes;
}

SensorModel with_free_noise(SensorModel model, const std::vector<std::size_t>& axes) {
    for (const std::size_t axis : axes) {
        for (const char name : names) { model.axes[axis].sd_rel[std::string(1, name)] = free_sd_rel; }
    }
    return model;
}

std::vector<SwallowedNoise> fitted_noise(const Observation& observation,
                                         const std::vector<std::size_t>& axes) {
    std::vector<SwallowedNoise> fitted;
    for (const std::size_t axis : axes) {
        const NoiseNuisance& seen = observation.axis(axis).noise;
        const SensorModel& model = observation.baseline().model();
        const std::array<double, 3> sd_rel = noise_uncertainty(model, axis);
        NoiseCoefficients stated = model.axes[axis].noise;
        for (std::size_t index = 0; index < names.size(); ++index) {
            const double value = coefficient_of(stated, index);
            if (!(value > 0.0)) { continue; }
            fitted.push_back({axis, names.at(index), value, value * (1.0 + sd_rel[index] * seen.z[index]),
                              value * sd_rel[index] * seen.sd_z[index]});
        }
    }
    return fitted;
}

SensorModel with_noise(SensorModel model, const std::vector<SwallowedNoise>& noise) {
    for (const SwallowedNoise& one : noise) {
        const auto index =
            static_cast<std::size_t>(std::ranges::find(names, one.coefficient) - names.begin());
        AxisModel& axis = model.axes[one.axis];
        coefficient_of(axis.noise, index) = one.fitted;
        axis.sd_rel[std::string(1, one.coefficient)] = one.fitted_sd / one.fitted;
    }
    return model;
}

}  // namespace gyrolog
