#include "analysis/diagnose/swallowed_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/noise/noise_model.hpp"

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

bool has_no_white_noise(const SensorModel& model, std::size_t axis) {
    return !(model.axes[axis].noise.N_rad_per_sqrt_s > 0.0);
}

// Where white noise is looked for that a fit gave to another coefficient: nothing else is there in every
// octave.
constexpr double octaves = 5.0;

// The density that is highest in an octave of the upper ones; a filter may have cut the last.
double seen_white_density(const Observation& observation, std::size_t axis) {
    const SpectralBins& bins = observation.baseline().bins();
    const std::vector<double>& power = observation.axis(axis).power;
    double most = 0.0;
    double end_hz = bins.back().f_hz * 1.001;
    const double least_hz = end_hz * std::exp2(-octaves);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = bins.size(); i-- > 0 && end_hz > least_hz;) {
        if (bins[i].f_hz < 0.5 * end_hz) {
            most = std::max(most, sum / count);
            end_hz *= 0.5;
            sum = count = 0.0;
        }
        sum += bins[i].count() * power[i];
        count += bins[i].count();
    }
    return most;
}

// Of a rate random walk that makes all of the slowest noise there is.
double seen_walk_rad_s_sqrt_s(const Observation& observation, std::size_t axis) {
    constexpr std::size_t slowest = 8;
    const SpectralBins& bins = observation.baseline().bins();
    double sum = 0.0;
    for (std::size_t i = 0; i < slowest; ++i) {
        const double omega = 2.0 * pi * bins[i].f_hz;
        sum += observation.axis(axis).power[i] * omega * omega;
    }
    return std::sqrt(sum / static_cast<double>(slowest));
}

bool has_swallowed_noise(const Observation& observation, std::size_t axis) {
    const Baseline& baseline = observation.baseline();
    const AxisObservation& seen = observation.axis(axis);
    const std::array<double, 3> stated = noise_uncertainty(baseline.model(), axis);
    std::array<double, 3> sd_rel = {stated[0], free_sd_rel, free_sd_rel};
    std::vector<SpectralParts> parts = baseline.parts(axis);
    if (has_no_white_noise(baseline.model(), axis)) {
        const double white = seen_white_density(observation, axis);
        for (SpectralParts& part : parts) { part.white = white; }
        sd_rel[0] = free_sd_rel;
    }
    const auto fit = [&] { return fit_nuisance(baseline.bins(), parts, seen.power, sd_rel); };
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

SensorModel with_free_noise(SensorModel model, const Observation& seen,
                            const std::vector<std::size_t>& axes) {
    for (const std::size_t axis : axes) {
        for (const char name : names) { model.axes[axis].sd_rel[std::string(1, name)] = free_sd_rel; }
        if (has_no_white_noise(model, axis)) {
            model.axes[axis].noise.N_rad_per_sqrt_s = std::sqrt(seen_white_density(seen, axis));
        }
        double& walk = model.axes[axis].noise.K_rad_per_s_sqrt_s;
        if (!(walk > 0.0)) { walk = seen_walk_rad_s_sqrt_s(seen, axis); }
    }
    return model;
}

std::vector<SwallowedNoise> fitted_noise(const Observation& observation, const SensorModel& stated,
                                         const std::vector<std::size_t>& axes) {
    std::vector<SwallowedNoise> fitted;
    for (const std::size_t axis : axes) {
        const NoiseNuisance& seen = observation.axis(axis).noise;
        const SensorModel& model = observation.baseline().model();
        const std::array<double, 3> sd_rel = noise_uncertainty(model, axis);
        NoiseCoefficients before = stated.axes[axis].noise;
        NoiseCoefficients freed = model.axes[axis].noise;
        for (std::size_t index = 0; index < names.size(); ++index) {
            const double value = coefficient_of(freed, index);
            if (!(value > 0.0)) { continue; }
            fitted.push_back({axis, names.at(index), coefficient_of(before, index),
                              value * (1.0 + sd_rel[index] * seen.z[index]),
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
