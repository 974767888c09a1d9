#include "host/formats/simulators/simulator_source.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "analysis/simulate/effect_axes.hpp"
#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

double param(const EffectModel& effect, const std::string& name) {
    const auto found = effect.params.find(name);
    return found == effect.params.end() ? 0.0 : found->second;
}

// 0: none.
double range_of(const SensorModel& model) {
    return model.full_scale_rad_s < no_range_rad_s ? model.full_scale_rad_s : 0.0;
}

// Part of still_noise(), and of what a simulator is given of it.
bool is_noise_term(std::string_view effect, const SimulatorAbilities& abilities) {
    if (!abilities.noise) { return false; }
    if (!abilities.projects) { return effect == "arw_scale" || effect == "rrw_missing"; }
    constexpr std::array<std::string_view, 6> terms = {"arw_scale",    "flicker_missing", "rrw_missing",
                                                       "gauss_markov", "angle_noise",     "rate_ramp"};
    return std::ranges::find(terms, effect) != terms.end();
}

std::vector<std::string> terms_left_out(const SensorModel& model, const SimulatorAbilities& abilities) {
    std::vector<std::string> left;
    const auto leave = [&](bool there, bool taken, const char* what) {
        if (there && !taken) { left.emplace_back(what); }
    };
    const auto any_axis = [&](auto has) { return std::ranges::any_of(model.axes, has); };
    const bool has_noise = abilities.noise.has_value();
    const bool in_error = has_noise && abilities.projects;
    leave(any_axis([](const AxisModel& a) { return a.noise.N_rad_per_sqrt_s != 0.0; }), has_noise,
          "white noise N");
    const auto any_effect = [&](const char* name) {
        return in_error && std::ranges::count(model.effects, name, &EffectModel::effect) > 0;
    };
    leave(any_axis([](const AxisModel& a) { return a.noise.B_rad_per_s != 0.0; }) ||
              any_effect("flicker_missing"),
          false,
          in_error ? "bias instability B as 1/f noise (it is in the error above)" : "bias instability B");
    leave(any_axis([](const AxisModel& a) { return a.noise.Q_rad != 0.0; }) || any_effect("angle_noise"),
          false, in_error ? "angle quantisation Q (it is in the error above)" : "angle quantisation Q");
    leave(any_axis([](const AxisModel& a) { return a.noise.R_rad_per_s2 != 0.0; }) || any_effect("rate_ramp"),
          false, in_error ? "the rate ramp R (it is in the error above)" : "the rate ramp R");
    leave(any_axis([](const AxisModel& a) { return a.bias_rad_s != 0.0; }), abilities.bias, "the bias");
    leave(model.lsb_rad_s != 0.0, abilities.rounds,
          in_error ? "the converter's steps (their noise is in the white noise)" : "the converter's steps");
    leave(range_of(model) != 0.0, abilities.clips, "the range");
    leave(model.M != identity_matrix, abilities.cross_axis, "scale and misalignment M");
    leave(model.misalignment.has_value(), false, "misalignment_percent");
    leave(model.latency_s != 0.0, abilities.delays, "latency_s");
    leave(model.timestamp_jitter_s != 0.0, false, "timestamp_jitter_s");
    leave(model.temperature.has_value(), false, "the temperature coefficients");
    std::set<std::string> effects;
    for (const EffectModel& effect : model.effects) {
        if (!is_noise_term(effect.effect, abilities)) { effects.insert(effect.effect); }
    }
    for (const std::string& effect : effects) { left.push_back("effect " + printable(effect)); }
    return left;
}

// Those of the axis where each is largest, so that no axis is trusted too much.
NoiseProjection largest_terms(std::span<const NoiseModel> axes) {
    NoiseProjection terms;
    for (const NoiseModel& axis : axes) {
        terms.N_rad_per_sqrt_s = std::max(terms.N_rad_per_sqrt_s, axis.coefficients.N_rad_per_sqrt_s);
        terms.K_rad_per_s_sqrt_s = std::max(terms.K_rad_per_s_sqrt_s, axis.coefficients.K_rad_per_s_sqrt_s);
    }
    return terms;
}

std::string error_text(const NoiseProjection& noise) {
    if (std::isinf(noise.worst_dB)) { return "all of it"; }
    if (noise.worst_dB < 0.005) { return "none"; }
    return fmt::format("{:.2f} dB at {:.3g} s", noise.worst_dB, noise.worst_tau_s);
}

}  // namespace

double SimulatorSource::sample_sd_rad_s(std::size_t axis) const {
    return noise[axis].N_rad_per_sqrt_s * std::sqrt(rate_hz);
}

NoiseModel still_noise(const SensorModel& model, std::size_t axis) {
    NoiseModel noise{.coefficients = model.axes[axis].noise};
    NoiseCoefficients& of = noise.coefficients;
    for (const EffectModel& effect : model.effects) {
        if (!acts_on(effect, axis)) { continue; }
        if (effect.effect == "arw_scale") {
            of.N_rad_per_sqrt_s *= param(effect, "factor");
        } else if (effect.effect == "flicker_missing") {
            of.B_rad_per_s = std::hypot(of.B_rad_per_s, param(effect, "B_dps") * rad_per_deg);
        } else if (effect.effect == "rrw_missing") {
            of.K_rad_per_s_sqrt_s =
                std::hypot(of.K_rad_per_s_sqrt_s, param(effect, "K_dps_sqrt_hz") * rad_per_deg);
        } else if (effect.effect == "angle_noise") {
            of.Q_rad = std::hypot(of.Q_rad, param(effect, "Q_dps_s") * rad_per_deg);
        } else if (effect.effect == "rate_ramp") {
            of.R_rad_per_s2 += param(effect, "ramp_dps_per_s") * rad_per_deg;
        } else if (effect.effect == "gauss_markov") {
            noise.gauss_markov.push_back({param(effect, "sigma_dps") * rad_per_deg, param(effect, "tau_s")});
        }
    }
    return noise;
}

SimulatorSource simulator_source(const SensorModel& model, const std::string& name,
                                 const SimulatorAbilities& abilities, double horizon_s) {
    SimulatorSource source;
    source.name = printable(name);
    source.rate_hz = model.rate_hz;
    source.horizon_s = horizon_s;
    source.lsb_rad_s = model.lsb_rad_s;
    source.full_scale_rad_s = range_of(model);
    source.M = model.M;
    source.latency_s = model.latency_s;
    source.left_out = terms_left_out(model, abilities);
    std::vector<NoiseModel> axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        source.bias_rad_s[axis] = model.axes[axis].bias_rad_s;
        axes.push_back(still_noise(model, axis));
        if (!abilities.rounds && model.lsb_rad_s > 0.0) {
            axes.back().converter = {model.lsb_rad_s, model.rate_hz};
        }
    }
    if (!abilities.noise) { return source; }
    if (!abilities.projects) {
        source.noise.fill(largest_terms(axes));
        return source;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::span<const NoiseModel> used =
            abilities.per_axis ? std::span(axes).subspan(axis, 1) : std::span<const NoiseModel>(axes);
        source.noise[axis] = project_noise(used, *abilities.noise, model.rate_hz, horizon_s);
    }
    return source;
}

std::vector<std::string> head_lines(const SimulatorSource& source, const SimulatorAbilities& abilities) {
    std::vector<std::string> lines = {
        fmt::format("From {}, by gyrolog; for a sensor that is read {:.9g} times a second.", source.name,
                    source.rate_hz)};
    if (!abilities.noise) {
        lines.emplace_back("The simulator has no noise: none of the sensor's is in it.");
    } else if (!abilities.projects) {
        lines.emplace_back(
            "White noise N and rate random walk K as they are, of the axis where each is largest.");
    } else {
        lines.push_back(
            fmt::format("Noise nearest to the model's for averaging times from {:.3g} s to {:.6g} s. Largest "
                        "error of the "
                        "Allan deviation:",
                        1.0 / source.rate_hz, source.horizon_s));
        if (abilities.per_axis) {
            lines.push_back(fmt::format("x {}, y {}, z {}.", error_text(source.noise[0]),
                                        error_text(source.noise[1]), error_text(source.noise[2])));
        } else {
            lines.push_back(
                fmt::format("{}, on the axis where it is largest; the simulator has one number for "
                            "all axes.",
                            error_text(source.noise[0])));
        }
    }
    std::string left;
    for (const std::string& one : source.left_out) { left += (left.empty() ? "" : "; ") + one; }
    if (!left.empty()) { lines.push_back("Not in this file: " + left + "."); }
    return lines;
}

}  // namespace gyrolog
