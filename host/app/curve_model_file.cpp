#include "host/app/curve_model_file.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace gyrolog {
namespace {

void put_axis(const PrintedCurveReport& curve, std::size_t axis, ModelOfCurves& result) {
    AxisModel& noise = result.model.axes[axis];
    noise.noise = curve.fit.noise.best.coefficients;
    for (const NoiseTerm term : all_noise_terms) {
        const FittedCoefficient& fitted = curve.fit.noise[term];
        if (fitted.state == FittedCoefficient::State::identified) {
            noise.sd_rel[std::string(name_of(term))] = fitted.sd / fitted.value;
        }
    }
    for (const GaussMarkov& process : curve.fit.noise.best.gauss_markov) {
        EffectModel effect;
        effect.effect = "gauss_markov";
        effect.axes = {axis_names[axis]};
        effect.params = {{"sigma_dps", process.sigma_rad_per_s * deg_per_rad},
                         {"tau_s", process.correlation_s}};
        result.model.effects.push_back(std::move(effect));
    }
    for (const Sinusoid& line : curve.fit.noise.best.sinusoids) {
        result.warnings.push_back(fmt::format(
            "axis {}: the sinusoid of {:.3g} dps at {:.3g} Hz is not in the model: it is no noise",
            axis_names[axis], line.amplitude_rad_per_s * deg_per_rad, line.frequency_hz));
    }
}

}  // namespace

Result<ModelOfCurves> model_of_curves(const CurveReport& report, std::optional<double> rate_hz) {
    if (report.unit.sensor == SensorKind::accelerometer) {
        return Error{
            ErrorCode::invalid_argument,
            "a model is of a gyro, with its accelerometer beside it: curves of an accelerometer alone "
            "make none"};
    }
    ModelOfCurves result;
    double shortest_s = 0.0;
    std::string absent;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const auto curve = std::ranges::find(report.curves, axis_names[axis], &PrintedCurveReport::name);
        if (curve == report.curves.end()) {
            absent += fmt::format("{}{}", absent.empty() ? "" : ", ", axis_names[axis]);
            continue;
        }
        const double first_s = curve->curve.points.front().tau_s;
        shortest_s = shortest_s == 0.0 ? first_s : std::min(shortest_s, first_s);
        put_axis(*curve, axis, result);
    }
    if (shortest_s == 0.0) {
        return Error{ErrorCode::invalid_argument,
                     "a model needs curves named x, y or z (columns such as x_dps), and there is none"};
    }
    result.model.rate_hz = rate_hz.value_or(1.0 / shortest_s);
    result.model.full_scale_rad_s = no_range_rad_s;
    result.model.saturation_rad_s = no_range_rad_s;
    if (!absent.empty()) {
        result.warnings.push_back("no curve of axis " + absent + ": without noise in the model");
    }
    result.warnings.emplace_back("the model has no range and no bias: a curve does not tell them");
    if (!rate_hz) {
        result.warnings.push_back(fmt::format(
            "sampling rate of the model: {:.4g} Hz, from the shortest averaging time; --rate gives another",
            result.model.rate_hz));
    }
    return result;
}

}  // namespace gyrolog
