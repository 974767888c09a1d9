#include "analysis/simulate/fitted_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "analysis/recording/neighbour_scatter.hpp"
#include "analysis/simulate/recorded_converter.hpp"

namespace gyrolog {
namespace {

void add_relative_sd(const NoiseFit& fit, NoiseTerm term, std::map<std::string, double>& sd_rel) {
    const FittedCoefficient& coefficient = fit[term];
    if (coefficient.state == FittedCoefficient::State::identified && coefficient.value > 0.0) {
        sd_rel[std::string(name_of(term))] = coefficient.sd / coefficient.value;
    }
}

// How a sensor's model names and scales what its effects' parameters share with those of others.
struct EffectNames {
    const char* sigma;
    const char* amplitude;
    const char* slope;  // of the bias over the temperature
    double per_column_unit;
};

EffectNames effect_names(SensorKind sensor) {
    if (sensor == SensorKind::gyro) { return {"sigma_dps", "amplitude_dps", "c1_dps_per_C", deg_per_rad}; }
    return {"sigma_g", "amplitude_g", "c1_g_per_C", 1.0 / standard_gravity_m_s2};
}

// Noise beyond the five coefficients is an effect of the model. A line's phase is not reported: it is that of
// no particular recording.
void add_effects(const NoiseFit& fit, const std::string& axis, const EffectNames& names,
                 std::vector<EffectModel>& effects) {
    for (const FittedGaussMarkov& noise : fit.gauss_markov) {
        effects.push_back({"gauss_markov",
                           {axis},
                           {{names.sigma, noise.value.sigma_rad_per_s * names.per_column_unit},
                            {"tau_s", noise.value.correlation_s}},
                           {}});
    }
    for (const FittedSinusoid& line : fit.sinusoids) {
        effects.push_back({"tone",
                           {axis},
                           {{"f_hz", line.value.frequency_hz},
                            {names.amplitude, line.value.amplitude_rad_per_s * names.per_column_unit},
                            {"phase_rad", 0.0}},
                           {}});
    }
}

// What was taken off the samples is in no noise: the model has it as an effect.
void add_drift(const AxisReport& axis, const EffectNames& names, std::vector<EffectModel>& effects) {
    if (!axis.temperature || !axis.temperature->is_taken_off) { return; }
    effects.push_back({"temp_linear",
                       {axis.axis},
                       {{names.slope, axis.temperature->slope_per_C * names.per_column_unit},
                        {"reference_C", axis.temperature->mean_C}},
                       {}});
}

// The sensor's known filter, on the axes that came through it.
void add_filter(double bandwidth_hz, const std::string& axis, std::vector<EffectModel>& effects) {
    if (bandwidth_hz == 0.0) { return; }
    const auto filter = std::ranges::find_if(effects, [&](const EffectModel& effect) {
        return effect.effect == "lowpass" && effect.params.at("fc_hz") == bandwidth_hz;
    });
    if (filter != effects.end()) {
        filter->axes.push_back(axis);
    } else {
        effects.push_back({"lowpass", {axis}, {{"fc_hz", bandwidth_hz}}, {}});
    }
}

// What the models of a gyro and of an accelerometer have in common, in the columns' unit.
struct FittedSensor {
    std::array<AxisModel, 3> axes;
    std::vector<EffectModel> effects;
    RecordedConverter converter;  // of the first axis that has a step
    bool has_axes = false;
};

FittedSensor fitted_sensor(const std::vector<AxisReport>& reports, SensorKind sensor,
                           const Recording& recording) {
    FittedSensor fitted;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const auto found = std::ranges::find(reports, axis_names[axis], &AxisReport::axis);
        if (found == reports.end()) { continue; }
        fitted.has_axes = true;
        AxisModel& model = fitted.axes[axis];
        model.noise = found->fit.identified().coefficients;
        // The mean of an accelerometer at rest is gravity: one position does not tell the bias in it.
        if (sensor == SensorKind::gyro) { model.bias_rad_s = found->bias.value; }
        for (const NoiseTerm term : all_noise_terms) { add_relative_sd(found->fit, term, model.sd_rel); }
        add_effects(found->fit, axis_names[axis], effect_names(sensor), fitted.effects);
        add_drift(*found, effect_names(sensor), fitted.effects);
        add_filter(found->fit.bandwidth_hz, axis_names[axis], fitted.effects);
        const char* prefix = sensor == SensorKind::gyro ? "g" : "a";
        const Column* column = recording.find(std::string(prefix) + axis_names[axis]);
        if (column != nullptr && fitted.converter.step_rad_s == 0.0) {
            fitted.converter = recorded_converter(
                *column, column->is_counts() ? column->scale : found->fit.best.converter.step_rad_per_s,
                fitted.converter.full_scale_rad_s, sensor);
        }
    }
    return fitted;
}

std::optional<AccelerometerModel> fitted_accelerometer(const AnalysisReport& report,
                                                       const Recording& recording) {
    if (!report.accelerometer || report.accelerometer->unit.is_counts()) { return std::nullopt; }
    FittedSensor fitted = fitted_sensor(report.accelerometer->axes, SensorKind::accelerometer, recording);
    if (!fitted.has_axes) { return std::nullopt; }
    AccelerometerModel model;
    model.axes = fitted.axes;
    model.effects = std::move(fitted.effects);
    model.lsb_m_s2 = fitted.converter.step_rad_s;
    model.full_scale_m_s2 = fitted.converter.full_scale_rad_s;
    model.saturation_m_s2 = fitted.converter.saturation_rad_s;
    return model;
}

// Time stamps come from a crystal, and one of common make keeps to some 50 ppm: what scatters less about its
// own line is not known better than that to another clock.
constexpr double crystal_rel = 5e-5;

}  // namespace

SensorModel fitted_model(const AnalysisReport& report, const Recording& recording) {
    SensorModel model;
    model.rate_hz = report.rate_hz;
    FittedSensor gyro = fitted_sensor(report.axes, SensorKind::gyro, recording);
    model.axes = gyro.axes;
    model.effects = std::move(gyro.effects);
    model.lsb_rad_s = gyro.converter.step_rad_s;
    model.full_scale_rad_s = gyro.converter.full_scale_rad_s;
    model.saturation_rad_s = gyro.converter.saturation_rad_s;
    model.accelerometer = fitted_accelerometer(report, recording);
    if (report.rate_sd_hz && report.rate_hz > 0.0) {
        model.sd_abs["rate_rel"] = std::hypot(*report.rate_sd_hz / report.rate_hz, crystal_rel);
    }
    if (recording.stamps == StampKind::sampling) {
        model.timestamp_jitter_s = recording.stamp_jitter_s.value_or(0.0);
    }
    if (const Column* column = recording.find("temp"); column != nullptr && column->unit == "degC") {
        model.temp_noise_C = neighbour_scatter(*column, recording.segments);
    }
    // Without a recording to follow, the simulated temperature stays about the one at which the bias is so.
    for (const AxisReport& axis : report.axes) {
        if (!axis.temperature || !axis.temperature->is_taken_off) { continue; }
        model.temperature = TemperatureModel{};
        model.temperature->reference_C = axis.temperature->mean_C;
        break;
    }
    return model;
}

}  // namespace gyrolog
