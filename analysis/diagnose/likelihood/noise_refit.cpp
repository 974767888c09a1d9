#include "analysis/diagnose/likelihood/noise_refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog::resolution {

// What a fit gave to another coefficient is looked for in the octaves of the recording: one of them is mostly
// of each kind, or was before a filter cut it. Below this many octaves from the top nothing is mostly white.
constexpr std::size_t white_octaves = 5;
// Fewer may all be small by chance.
constexpr double coefficients_least = 16.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

constexpr std::array<char, 3> names = {'N', 'B', 'K'};

double& coefficient_of(NoiseCoefficients& noise, std::size_t index) {
    return *std::array{&noise.N_rad_per_sqrt_s, &noise.B_rad_per_s, &noise.K_rad_per_s_sqrt_s}.at(index);
}

struct Octave {
    double omega_rad_s = 0.0;  // in the middle
    double density = 0.0;
};

// From the top on.
std::vector<Octave> seen_octaves(const Observation& observation, std::size_t axis) {
    const SpectralBins& bins = observation.prediction().bins();
    const std::vector<double>& power = observation.axis(axis).power;
    std::vector<Octave> octaves;
    double end_hz = bins.back().f_hz * 1.001;
    double sum = 0.0;
    double count = 0.0;
    const auto close = [&] {
        if (count >= resolution::coefficients_least) {
            octaves.push_back({2.0 * pi * std::sqrt(0.5) * end_hz, sum / count});
        }
        end_hz *= 0.5;
        sum = count = 0.0;
    };
    for (std::size_t i = bins.size(); i-- > 0;) {
        while (bins[i].f_hz < 0.5 * end_hz) { close(); }
        sum += bins[i].count() * power[i];
        count += bins[i].count();
    }
    close();
    return octaves;
}

double white_density(const std::vector<Octave>& octaves) {
    double most = 0.0;
    for (std::size_t i = 0; i < std::min(octaves.size(), resolution::white_octaves); ++i) {
        most = std::max(most, octaves[i].density);
    }
    return most;
}

// What is stated as nothing, as far as it can be what is seen. Whether there is such.
bool state_what_is_seen(NoiseCoefficients& noise, const Observation& seen, std::size_t axis) {
    const bool has_all =
        noise.N_rad_per_sqrt_s > 0.0 && noise.B_rad_per_s > 0.0 && noise.K_rad_per_s_sqrt_s > 0.0;
    if (has_all) { return false; }
    const std::vector<Octave> octaves = seen_octaves(seen, axis);
    if (!(noise.N_rad_per_sqrt_s > 0.0)) { noise.N_rad_per_sqrt_s = std::sqrt(white_density(octaves)); }
    if (!(noise.B_rad_per_s > 0.0)) {
        double least = octaves.front().density * octaves.front().omega_rad_s;
        for (const Octave& octave : octaves) { least = std::min(least, octave.density * octave.omega_rad_s); }
        noise.B_rad_per_s = std::sqrt(least);
    }
    if (!(noise.K_rad_per_s_sqrt_s > 0.0)) {
        const Octave& slowest = octaves.back();
        noise.K_rad_per_s_sqrt_s = std::sqrt(slowest.density) * slowest.omega_rad_s;
    }
    return true;
}

bool needs_refit(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    SensorModel model = prediction.model();
    // Every sensor has white noise: a fit that states none gave it to the others.
    if (!(model.axes[axis].noise.N_rad_per_sqrt_s > 0.0)) { return true; }
    std::array<double, 3> sd_rel = noise_uncertainty(model, axis);
    // What the model has as nothing is free in any case.
    std::vector<SpectralParts> parts = prediction.parts(axis);
    if (state_what_is_seen(model.axes[axis].noise, observation, axis)) {
        NoiseCoefficients stated = prediction.model().axes[axis].noise;
        for (std::size_t index = 0; index < names.size(); ++index) {
            if (!(coefficient_of(stated, index) > 0.0)) { sd_rel.at(index) = decisions.unknown_sd_rel; }
        }
        parts = prediction.with(model)->parts(axis);
    }
    const auto fit = [&] { return fit_nuisance(prediction.bins(), parts, seen.power, sd_rel); };
    const double kept_nats = fit().log_likelihood_nats;
    const std::array<double, 3> kept = sd_rel;
    sd_rel[1] = sd_rel[2] = decisions.unknown_sd_rel;
    NoiseNuisance freed = fit();
    for (const std::size_t index : {std::size_t{1}, std::size_t{2}}) {
        // More noise than stated has names of its own among the effects.
        if (freed.z[index] < 0.0) { continue; }
        sd_rel[index] = kept[index];
        freed = fit();
    }
    return freed.log_likelihood_nats - kept_nats > decisions.seen_nats();
}

}  // namespace

std::vector<std::size_t> axes_to_refit(const Observation& observation) {
    std::vector<std::size_t> axes = observation.prediction().axes();
    std::erase_if(axes, [&](std::size_t axis) { return !needs_refit(observation, axis); });
    return axes;
}

SensorModel with_free_noise(SensorModel model, const Observation& seen,
                            const std::vector<std::size_t>& axes) {
    for (const std::size_t axis : axes) {
        for (const char name : names) {
            model.axes[axis].sd_rel[std::string(1, name)] = decisions.unknown_sd_rel;
        }
        static_cast<void>(state_what_is_seen(model.axes[axis].noise, seen, axis));
    }
    return model;
}

std::vector<NoiseRefit> fitted_noise(const Observation& observation, const SensorModel& stated,
                                     const std::vector<std::size_t>& axes) {
    std::vector<NoiseRefit> fitted;
    for (const std::size_t axis : axes) {
        const NoiseNuisance& seen = observation.axis(axis).noise;
        const SensorModel& model = observation.prediction().model();
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

SensorModel with_noise(SensorModel model, const std::vector<NoiseRefit>& noise) {
    for (const NoiseRefit& one : noise) {
        const auto index =
            static_cast<std::size_t>(std::ranges::find(names, one.coefficient) - names.begin());
        AxisModel& axis = model.axes[one.axis];
        coefficient_of(axis.noise, index) = one.fitted;
        axis.sd_rel[std::string(1, one.coefficient)] = one.fitted_sd / one.fitted;
    }
    return model;
}

}  // namespace gyrolog
