#include "analysis/diagnose/multiscale/means_model.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {
namespace {

bool is_line_entry(const EffectModel& entry) { return traits_of(entry.effect).is_line; }
bool is_of_single_samples(const EffectModel& entry) {
    return traits_of(entry.effect).far_off == FarOff::single_samples;
}

// What single samples are off by, in a mean of `samples`; with its inverse, back again.
void scale_sizes(std::map<std::string, double>& values, double by) {
    for (auto& [name, value] : values) {
        if (name.ends_with("_dps")) { value *= by; }
    }
}

// A line's amplitude and phase.
void turn(EffectModel& line, std::complex<double> by) {
    const double phase_rad = EffectValues(line)["phase_rad"] + std::arg(by);
    line.params["amplitude_dps"] *= std::abs(by);
    line.params["phase_rad"] = std::remainder(phase_rad, 2.0 * std::numbers::pi);
}

}  // namespace

std::complex<double> line_in_means(double f_hz, double rate_hz, std::size_t samples) {
    const auto number = static_cast<double>(samples);
    const double half_turn = std::numbers::pi * f_hz / rate_hz;
    const double sine = std::sin(half_turn);
    const double kernel = std::abs(sine) < 1e-12 ? 1.0 : std::sin(half_turn * number) / (number * sine);
    return kernel * std::polar(1.0, half_turn * (number - 1.0));
}

SensorModel model_of_means(SensorModel model, std::size_t samples, double rate_hz) {
    if (samples < 2) { return model; }
    const auto number = static_cast<double>(samples);
    const double converter = model.lsb_rad_s * model.lsb_rad_s / (12.0 * rate_hz);
    for (AxisModel& axis : model.axes) {
        axis.noise.N_rad_per_sqrt_s = std::hypot(axis.noise.N_rad_per_sqrt_s, std::sqrt(converter));
    }
    model.lsb_rad_s = 0.0;
    model.rate_hz /= number;
    for (double* sd :
         {&model.ref_noise_rad_s, &model.acc_noise_m_s2, &model.temp_noise_C, &model.timestamp_jitter_s}) {
        *sd /= std::sqrt(number);
    }
    for (EffectModel& entry : model.effects) {
        if (is_line_entry(entry)) { turn(entry, line_in_means(entry.params.at("f_hz"), rate_hz, samples)); }
        if (is_of_single_samples(entry)) { scale_sizes(entry.params, 1.0 / number); }
    }
    std::erase_if(model.effects, [](const EffectModel& entry) {
        const EffectSignature* signature = find_effect(entry.effect)->signature;
        return signature == nullptr || !shows_in_means(*signature);
    });
    return model;
}

Finding finding_of_samples(Finding finding, std::size_t samples, double rate_hz) {
    for (std::size_t i = 0; i < finding.entries.size(); ++i) {
        EffectModel& entry = finding.entries[i];
        if (is_of_single_samples(entry)) {
            scale_sizes(entry.params, static_cast<double>(samples));
            if (i < finding.sd.size()) { scale_sizes(finding.sd[i], static_cast<double>(samples)); }
        }
        if (!is_line_entry(entry)) { continue; }
        const std::complex<double> of_sample = 1.0 / line_in_means(entry.params.at("f_hz"), rate_hz, samples);
        turn(entry, of_sample);
        if (i < finding.sd.size() && finding.sd[i].contains("amplitude_dps")) {
            finding.sd[i]["amplitude_dps"] *= std::abs(of_sample);
        }
    }
    return finding;
}

}  // namespace gyrolog
