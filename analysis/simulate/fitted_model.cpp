#include "analysis/simulate/fitted_model.hpp"

#include <algorithm>

namespace gyrolog {
namespace {

constexpr double codes_of_a_side = 32768.0;  // of a 16-bit converter

void add_relative_sd(const NoiseFit& fit, NoiseTerm term, std::map<std::string, double>& sd_rel) {
    const FittedCoefficient& coefficient = fit[term];
    if (coefficient.state == FittedCoefficient::State::identified && coefficient.value > 0.0) {
        sd_rel[std::string(name_of(term))] = coefficient.sd / coefficient.value;
    }
}

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
        const Column* column = recording.find(std::string("g") + axis_names[axis]);
        if (column != nullptr && column->is_counts()) {
            model.lsb_rad_s = column->scale;
            model.full_scale_rad_s = codes_of_a_side * column->scale;
            model.saturation_rad_s = (codes_of_a_side - 1.0) * column->scale;
        }
    }
    if (report.rate_sd_hz && report.rate_hz > 0.0) {
        model.sd_abs["rate_rel"] = *report.rate_sd_hz / report.rate_hz;
    }
    return model;
}

}  // namespace gyrolog
