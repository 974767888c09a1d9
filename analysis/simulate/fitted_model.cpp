#include "analysis/simulate/fitted_model.hpp"

#include <algorithm>
#include <cmath>

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

// Noise beyond the five coefficients is an effect of the model. A line's phase is not reported: it is that of
// no particular recording.
void add_effects(const NoiseFit& fit, const std::string& axis, std::vector<EffectModel>& effects) {
    for (const FittedGaussMarkov& noise : fit.gauss_markov) {
        effects.push_back(
            {"gauss_markov",
             {axis},
             {{"sigma_dps", noise.value.sigma_rad_per_s * deg_per_rad}, {"tau_s", noise.value.correlation_s}},
             {}});
    }
    for (const FittedSinusoid& line : fit.sinusoids) {
        effects.push_back({"tone",
                           {axis},
                           {{"f_hz", line.value.frequency_hz},
                            {"amplitude_dps", line.value.amplitude_rad_per_s * deg_per_rad},
                            {"phase_rad", 0.0}},
                           {}});
    }
}

// Time stamps come from a crystal, and one of common make keeps to some 50 ppm: what scatters less about its
// own line is not known better than that to another clock.
constexpr double crystal_rel = 5e-5;

}  // namespace

SensorModel fitted_model(const AnalysisReport& report, const Recording& recording) {
    SensorModel model;
    model.rate_hz = report.rate_hz;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const auto found = std::ranges::find(report.axes, axis_names[axis], &AxisReport::axis);
        if (found == report.axes.end()) { continue; }
        AxisModel& fitted = model.axes[axis];
        fitted.noise = found->fit.identified().coefficients;
        fitted.bias_rad_s = found->bias.value;
        for (const NoiseTerm term : all_noise_terms) { add_relative_sd(found->fit, term, fitted.sd_rel); }
        add_effects(found->fit, axis_names[axis], model.effects);
        const Column* column = recording.find(std::string("g") + axis_names[axis]);
        if (column != nullptr && model.lsb_rad_s == 0.0) {
            const RecordedConverter converter = recorded_converter(
                *column, column->is_counts() ? column->scale : found->fit.best.converter.step_rad_per_s,
                model.full_scale_rad_s);
            model.lsb_rad_s = converter.step_rad_s;
            model.full_scale_rad_s = converter.full_scale_rad_s;
            model.saturation_rad_s = converter.saturation_rad_s;
        }
    }
    if (report.rate_sd_hz && report.rate_hz > 0.0) {
        model.sd_abs["rate_rel"] = std::hypot(*report.rate_sd_hz / report.rate_hz, crystal_rel);
    }
    if (recording.stamps == StampKind::sampling) {
        model.timestamp_jitter_s = recording.stamp_jitter_s.value_or(0.0);
    }
    if (const Column* column = recording.find("temp"); column != nullptr && column->unit == "degC") {
        model.temp_noise_C = neighbour_scatter(*column, recording.segments);
    }
    return model;
}

}  // namespace gyrolog
