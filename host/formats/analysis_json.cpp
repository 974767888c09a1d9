#include "host/formats/analysis_json.hpp"

#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

Json recording_json(const AnalysisReport& report, const RecordingFacts& facts) {
    Json json;
    json["name"] = report.name;
    if (!facts.board.empty()) { json["board"] = facts.board; }
    if (!facts.started.empty()) { json["started"] = facts.started; }
    if (facts.temperature_C) { json["temperature_C"] = *facts.temperature_C; }
    json["rate_hz"] = report.rate_hz;
    if (report.rate_sd_hz) { json["rate_sd_hz"] = *report.rate_sd_hz; }
    if (report.nominal_rate_hz) { json["nominal_rate_hz"] = *report.nominal_rate_hz; }
    json["duration_s"] = report.duration_s;
    json["samples"] = report.samples;
    json["dropouts"] = {{"events", report.dropouts}, {"samples", report.samples_missing}};
    if (report.stops > 0) { json["stops"] = {{"events", report.stops}, {"s", report.stopped_s}}; }
    json["segments"] = report.segments;
    return json;
}

Json point_json(const AllanPoint& point, const SensorUnit& unit) {
    return {{"m", point.m},
            {"tau_s", point.tau_s},
            {"value", point.deviation * unit.per_column_unit},
            {"lo", point.lo * unit.per_column_unit},
            {"hi", point.hi * unit.per_column_unit},
            {"edf", point.edf},
            {"terms", point.terms},
            {"unit", unit.name}};
}

// How well the samples' spectrum follows the model.
Json fit_json(const NoiseFit& fit) {
    Json json = {{"model_error", fit.model_error}};
    if (fit.upper_frequency_hz > 0.0) { json["upper_frequency_hz"] = fit.upper_frequency_hz; }
    if (fit.bandwidth_hz > 0.0) { json["bandwidth_hz"] = fit.bandwidth_hz; }
    if (fit.worst_frequency_hz > 0.0) {
        json["worst_frequency_hz"] = fit.worst_frequency_hz;
        json["worst_ratio"] = fit.worst_ratio;
    }
    return json;
}

Json lines_json(const std::vector<SpectralLine>& lines, const SensorUnit& unit) {
    Json list = Json::array();
    for (const SpectralLine& line : lines) {
        Json one = {{"frequency_hz", line.f_hz},
                    {"frequency_sd_hz", line.f_sd_hz},
                    {"amplitude", line.amplitude * unit.per_column_unit},
                    {"amplitude_sd", line.amplitude_sd * unit.per_column_unit},
                    {"unit", unit.name},
                    {"false_alarm", line.false_alarm},
                    {"steady", line.steady}};
        if (!line.steady) { one["width_hz"] = line.width_hz; }
        list.push_back(std::move(one));
    }
    return list;
}

Json expanded_json(const ExpandedNumber& number, double scale, const std::string& unit) {
    return {{"value", number.value * scale},
            {"expanded_uncertainty", number.expanded_uncertainty * scale},
            {"coverage_factor", number.coverage_factor},
            {"unit", unit}};
}

Json temperature_json(const TemperatureDrift& drift, const SensorUnit& unit) {
    const auto number = [&](double value, const char* per) {
        return Json{{"value", value * unit.per_column_unit}, {"unit", unit.name + per}};
    };
    Json json;
    json["state"] = drift.is_there ? "identified" : "not_identifiable";
    json["coefficient"] = number(drift.slope_per_C, "/degC");
    json["coefficient"]["sd"] = drift.sd_per_C * unit.per_column_unit;
    json["chance"] = drift.chance;
    json["false_alarm"] = drift.false_alarm;
    json["taken_off"] = drift.is_taken_off;
    json["from_C"] = drift.from_C;
    json["to_C"] = drift.to_C;
    json["reference_C"] = drift.mean_C;
    json["K_left_in"] = number(drift.walk_left_in, "*sqrt(Hz)");
    json["K_taken_off"] = number(drift.walk_without, "*sqrt(Hz)");
    return json;
}

Json axis_json(const AxisReport& axis, const SensorUnit& unit) {
    Json json;
    // An accelerometer's mean is gravity and bias together.
    const char* mean = unit.sensor == SensorKind::gyro ? "bias" : "mean";
    json[mean] = expanded_json({axis.bias.value, axis.bias.expanded_uncertainty, axis.bias.coverage_factor},
                               unit.per_column_unit, unit.name);
    if (axis.temperature) { json["temperature"] = temperature_json(*axis.temperature, unit); }
    json["allan"] = Json::array();
    for (const AllanPoint& point : axis.curve.points) { json["allan"].push_back(point_json(point, unit)); }
    put_noise_fit(json, axis.fit, unit);
    if (axis.fit.method == FitMethod::likelihood) { json["fit"] = fit_json(axis.fit); }
    json["lines"] = lines_json(axis.lines, unit);
    if (axis.outliers.samples > 0) {
        json["outliers"] = {{"samples", axis.outliers.samples},
                            {"threshold", axis.outliers.threshold * unit.per_column_unit},
                            {"unit", unit.name}};
    }
    json["slope_read"] = slopes_json(axis.slopes, unit);
    return json;
}

Json axes_json(const std::vector<AxisReport>& axes, const SensorUnit& unit) {
    Json json = Json::object();
    for (const AxisReport& axis : axes) { json[axis.axis] = axis_json(axis, unit); }
    return json;
}

Json gravity_json(const Gravity& gravity, const SensorUnit& unit) {
    Json json;
    json["size"] = expanded_json(gravity.size, unit.per_column_unit, unit.name);
    json["tilt"] = expanded_json(gravity.tilt_rad, deg_per_rad, "deg");
    json["up"] = gravity.up_name();
    json["direction"] = gravity.direction;
    return json;
}

// Of an array, by the units' numbers.
Json accelerometer_json(const AccelerometerReport& report) {
    Json json;
    json["axes"] = axes_json(report.axes, report.unit);
    for (const AccelerometerReport::UnitGravity& of : report.gravity) {
        Json gravity = gravity_json(of.gravity, report.unit);
        if (of.unit.empty()) {
            json["gravity"].update(gravity);
        } else {
            json["gravity"][of.unit] = std::move(gravity);
        }
    }
    return json;
}

}  // namespace

std::string analysis_json(const AnalysisReport& report, const RecordingFacts& facts) {
    Json json;
    json["schema"] = "gyrolog-analysis/1";
    json["recording"] = recording_json(report, facts);
    json["deviation"] = name_of(report.kind);
    json["convention"] = name_of(report.convention);
    json["confidence"] = report.confidence;
    json["axes"] = axes_json(report.axes, report.unit);
    if (report.accelerometer) { json["accelerometer"] = accelerometer_json(*report.accelerometer); }
    json["warnings"] = report.warnings;
    return json_text(json);
}

}  // namespace gyrolog
