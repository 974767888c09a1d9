#include "host/formats/export_source.hpp"

#include <algorithm>

#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

ExportedTerm term_of(const FittedCoefficient& fitted) {
    if (fitted.state == FittedCoefficient::State::identified) { return {true, fitted.value, std::nullopt}; }
    return {false, 0.0, fitted.upper};
}

ExportedAxis exported_axis(const std::string& name, const NoiseFit& fit, double bias,
                           std::optional<double> flat_tau_s) {
    return {
        name,      term_of(fit[NoiseTerm::N]), term_of(fit[NoiseTerm::B]), term_of(fit[NoiseTerm::K]), bias,
        flat_tau_s};
}

std::optional<double> flat_tau_of(const SlopeReading& slopes) {
    return slopes.B ? std::optional(slopes.B->tau_s) : std::nullopt;
}

// x, y and z, as far as there are.
std::vector<ExportedAxis> exported_axes(const std::vector<AxisReport>& axes) {
    std::vector<ExportedAxis> exported;
    for (const char* name : axis_names) {
        const auto axis = std::ranges::find(axes, name, &AxisReport::axis);
        if (axis == axes.end()) { continue; }
        exported.push_back(exported_axis(name, axis->fit, axis->bias.value, flat_tau_of(axis->slopes)));
    }
    return exported;
}

ExportedTerm term_of_model(double value) {
    if (value > 0.0) { return {true, value, std::nullopt}; }
    return {};
}

std::vector<ExportedAxis> exported_axes(const std::array<AxisModel, 3>& axes) {
    std::vector<ExportedAxis> exported;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const AxisModel& of = axes[axis];
        exported.push_back({axis_names[axis], term_of_model(of.noise.N_rad_per_sqrt_s),
                            term_of_model(of.noise.B_rad_per_s), term_of_model(of.noise.K_rad_per_s_sqrt_s),
                            of.bias_rad_s, std::nullopt});
    }
    return exported;
}

// One value for three axes: the coarsest.
std::optional<double> accelerometer_step_m_s2(const Recording& recording) {
    std::optional<double> step;
    for (const char* name : axis_names) {
        const Column* column = recording.find(std::string("a") + name);
        if (column != nullptr && column->is_counts() && column->unit == "m/s^2") {
            step = std::max(step.value_or(0.0), column->scale);
        }
    }
    return step;
}

void add_effects(std::vector<std::string>& effects, const std::vector<EffectModel>& of, const char* sensor) {
    for (const EffectModel& effect : of) {
        const std::string name = printable(effect.effect) + " of the " + sensor;
        if (std::ranges::find(effects, name) == effects.end()) { effects.push_back(name); }
    }
}

}  // namespace

const ExportedAxis* ExportSource::gyro_axis(std::string_view axis) const {
    const auto found = std::ranges::find(gyro, axis, &ExportedAxis::name);
    return found == gyro.end() ? nullptr : &*found;
}

ExportSource export_source(const Recording& recording, const AnalysisReport& report) {
    ExportSource source;
    source.name = printable(report.name);  // it stands in comments of programs
    source.rate_hz = report.rate_hz;
    source.confidence = report.confidence;
    source.recording = &recording;
    source.report = &report;
    source.gyro = exported_axes(report.axes);
    for (const char* name : axis_names) {
        const Column* column = recording.find(std::string("g") + name);
        if (column != nullptr && column->is_counts() && column->unit == "rad/s") {
            constexpr double codes_of_a_side = 32768.0;  // of a 16-bit converter
            source.lsb_rad_s = column->scale;
            source.full_scale_rad_s = codes_of_a_side * column->scale;
        }
    }
    source.lsb_m_s2 = accelerometer_step_m_s2(recording);
    source.accelerometer_has_counts = report.accelerometer && report.accelerometer->unit.is_counts();
    if (report.accelerometer && !source.accelerometer_has_counts) {
        source.accelerometer = exported_axes(report.accelerometer->axes);
        for (ExportedAxis& axis : source.accelerometer) { axis.bias = 0.0; }  // gravity hides it
    }
    return source;
}

ExportSource export_source(const SensorModel& model, const std::string& name) {
    ExportSource source;
    source.name = printable(name);
    source.rate_hz = model.rate_hz;
    source.full_scale_rad_s = model.full_scale_rad_s;
    if (model.lsb_rad_s > 0.0) { source.lsb_rad_s = model.lsb_rad_s; }
    source.temperature = model.temperature;
    source.gyro = exported_axes(model.axes);
    add_effects(source.effects, model.effects, "gyro");
    if (model.accelerometer) {
        source.accelerometer = exported_axes(model.accelerometer->axes);
        if (model.accelerometer->lsb_m_s2 > 0.0) { source.lsb_m_s2 = model.accelerometer->lsb_m_s2; }
        add_effects(source.effects, model.accelerometer->effects, "accelerometer");
    }
    return source;
}

ExportedTerm largest(const std::vector<ExportedAxis>& axes, ExportedTerm ExportedAxis::*term) {
    ExportedTerm most;
    for (const ExportedAxis& axis : axes) {
        const ExportedTerm& one = axis.*term;
        most.identified = most.identified || one.identified;
        most.value = std::max(most.value, one.value);
        if (one.upper) { most.upper = std::max(most.upper.value_or(0.0), *one.upper); }
    }
    return most;
}

std::vector<std::string> warnings_of(const ExportSource& source) {
    return source.report == nullptr ? std::vector<std::string>() : source.report->warnings;
}

}  // namespace gyrolog
