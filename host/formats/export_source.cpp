#include "host/formats/export_source.hpp"

#include <algorithm>
#include <cmath>

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

// An accelerometer's columns are analysed here, because the report is about rates.
void add_accelerometer(ExportSource& source, const Recording& recording) {
    for (const char* axis : axis_names) {
        const Column* column = recording.find(std::string("a") + axis);
        if (column == nullptr || column->unit != "m/s^2") { continue; }
        const std::vector<double> values = column->values();
        if (std::ranges::any_of(values, [](double x) { return !std::isfinite(x); })) { continue; }
        AllanOptions options;
        options.threads = 0;
        const AllanCurve curve = allan_deviation(*column, recording.segments, recording.rate_hz, options);
        source.accelerometer.push_back(
            exported_axis(axis, fit_noise(curve), 0.0, flat_tau_of(read_slopes(curve))));
    }
}

ExportedTerm term_of_model(double value) {
    if (value > 0.0) { return {true, value, std::nullopt}; }
    return {};
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
    for (const char* name : axis_names) {
        const auto axis = std::ranges::find(report.axes, name, &AxisReport::axis);
        if (axis == report.axes.end()) { continue; }
        source.gyro.push_back(exported_axis(name, axis->fit, axis->bias.value, flat_tau_of(axis->slopes)));
        const Column* column = recording.find(std::string("g") + name);
        if (column != nullptr && column->is_counts() && column->unit == "rad/s") {
            constexpr double codes_of_a_side = 32768.0;  // of a 16-bit converter
            source.lsb_rad_s = column->scale;
            source.full_scale_rad_s = codes_of_a_side * column->scale;
        }
    }
    add_accelerometer(source, recording);
    return source;
}

ExportSource export_source(const SensorModel& model, const std::string& name) {
    ExportSource source;
    source.name = printable(name);
    source.rate_hz = model.rate_hz;
    source.full_scale_rad_s = model.full_scale_rad_s;
    if (model.lsb_rad_s > 0.0) { source.lsb_rad_s = model.lsb_rad_s; }
    source.temperature = model.temperature;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const AxisModel& of = model.axes[axis];
        source.gyro.push_back({axis_names[axis], term_of_model(of.noise.N_rad_per_sqrt_s),
                               term_of_model(of.noise.B_rad_per_s),
                               term_of_model(of.noise.K_rad_per_s_sqrt_s), of.bias_rad_s, std::nullopt});
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

}  // namespace gyrolog
