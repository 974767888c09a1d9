#include "host/formats/analysis_json.hpp"

#include <nlohmann/json.hpp>

#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

using Json = nlohmann::ordered_json;

Json recording_json(const AnalysisReport& report) {
    Json json;
    json["name"] = report.name;
    json["rate_hz"] = report.rate_hz;
    if (report.rate_sd_hz) { json["rate_sd_hz"] = *report.rate_sd_hz; }
    if (report.nominal_rate_hz) { json["nominal_rate_hz"] = *report.nominal_rate_hz; }
    json["duration_s"] = report.duration_s;
    json["samples"] = report.samples;
    json["dropouts"] = {{"events", report.dropouts}, {"samples", report.samples_missing}};
    json["segments"] = report.segments;
    return json;
}

Json point_json(const AllanPoint& point, const RateUnit& unit) {
    return {{"m", point.m},
            {"tau_s", point.tau_s},
            {"value", point.deviation * unit.per_column_unit},
            {"lo", point.lo * unit.per_column_unit},
            {"hi", point.hi * unit.per_column_unit},
            {"edf", point.edf},
            {"terms", point.terms},
            {"unit", unit.name}};
}

Json axis_json(const AxisReport& axis, const RateUnit& unit) {
    Json json;
    json["bias"] = {{"value", axis.bias.value * unit.per_column_unit},
                    {"expanded_uncertainty", axis.bias.expanded_uncertainty * unit.per_column_unit},
                    {"coverage_factor", axis.bias.coverage_factor},
                    {"unit", unit.name}};
    json["allan"] = Json::array();
    for (const AllanPoint& point : axis.curve.points) { json["allan"].push_back(point_json(point, unit)); }
    put_noise_fit(json, axis.fit, unit);
    json["slope_read"] = slopes_json(axis.slopes, unit);
    return json;
}

}  // namespace

std::string analysis_json(const AnalysisReport& report) {
    Json json;
    json["schema"] = "gyrolog-analysis/1";
    json["recording"] = recording_json(report);
    json["deviation"] = name_of(report.kind);
    json["convention"] = name_of(report.convention);
    json["confidence"] = report.confidence;
    json["axes"] = Json::object();
    for (const AxisReport& axis : report.axes) { json["axes"][axis.axis] = axis_json(axis, report.unit); }
    json["warnings"] = report.warnings;
    return json_text(json);
}

}  // namespace gyrolog
