#include "host/formats/curve_json.hpp"

#include <cmath>

#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"
#include "host/formats/noise_unit.hpp"

namespace gyrolog {
namespace {

Json term_json(const CurveTerm& term, const SensorUnit& unit) {
    Json json;
    json["term"] = name_of(term.kind);
    json["value"] = term.size * unit.per_column_unit;
    switch (term.kind) {
        case CurveTerm::Kind::gauss_markov:
            json["correlation_s"] = term.shape;
            json["unit"] = unit.name;
            break;
        case CurveTerm::Kind::sinusoid:
            json["frequency_hz"] = term.shape;
            json["unit"] = unit.name;
            break;
        default:
            json["unit"] = noise_unit(static_cast<NoiseTerm>(term.kind), unit);
    }
    return json;
}

void put_residual(Json& json, const CurveResidual& residual) {
    json["rms_db"] = residual.rms_db;
    json["worst_db"] = residual.worst_db;
    json["worst_tau_s"] = residual.worst_tau_s;
}

const char* name_of(CurveFitStep::Change change) {
    switch (change) {
        case CurveFitStep::Change::start:
            return "start";
        case CurveFitStep::Change::added:
            return "added";
        case CurveFitStep::Change::removed:
            return "removed";
    }
    return "";
}

Json ladder_json(const CurveModelFit& fit, const SensorUnit& unit) {
    Json ladder = Json::array();
    for (const CurveFitStep& step : fit.steps) {
        Json json;
        json["change"] = name_of(step.change);
        if (step.change != CurveFitStep::Change::start) { json["term"] = name_of(step.term); }
        put_residual(json, step.residual);
        json["bic"] = step.criterion;
        json["terms"] = Json::array();
        for (const CurveTerm& term : step.terms) { json["terms"].push_back(term_json(term, unit)); }
        ladder.push_back(std::move(json));
    }
    return ladder;
}

Json fit_json(const CurveModelFit& fit, const SensorUnit& unit) {
    Json json;
    put_residual(json, fit.residual);
    json["smooth_sd_db"] = fit.smooth_sd_db;
    json["ladder"] = ladder_json(fit, unit);
    json["not_called_for"] = Json::array();
    for (const RejectedTerm& rejected : fit.rejected) {
        Json one = term_json(rejected.term, unit);
        one["bic_gain"] = rejected.criterion_gain;
        one["rms_db"] = rejected.rms_db;
        json["not_called_for"].push_back(std::move(one));
    }
    return json;
}

Json curve_axis_json(const PrintedCurveReport& curve, const SensorUnit& unit) {
    Json json;
    json["allan"] = Json::array();
    for (const AllanPoint& point : curve.curve.points) {
        json["allan"].push_back(
            {{"tau_s", point.tau_s},
             {"value", point.deviation * unit.per_column_unit},
             {"model", std::sqrt(curve.fit.noise.best.allan_variance(point.tau_s)) * unit.per_column_unit},
             {"unit", unit.name}});
    }
    put_noise_fit(json, curve.fit.noise, unit);
    json["slope_read"] = slopes_json(curve.slopes, unit);
    json["fit"] = fit_json(curve.fit, unit);
    return json;
}

Json gap_json(const NamedCurveGap& named, const SensorUnit& unit) {
    Json json;
    json["sensor"] = named.sensor;
    json["simulation"] = named.simulation;
    json["points"] = named.gap.points;
    put_residual(json, named.gap.residual);
    json["stretches"] = Json::array();
    for (const CurveGapStretch& stretch : named.gap.stretches) {
        Json one = {{"from_tau_s", stretch.from_tau_s},
                    {"to_tau_s", stretch.to_tau_s},
                    {"worst_db", stretch.worst_db},
                    {"worst_tau_s", stretch.worst_tau_s}};
        if (stretch.term) {
            one["term"] = name_of(*stretch.term);
            one["share"] = stretch.share;
        }
        json["stretches"].push_back(std::move(one));
    }
    json["terms"] = Json::array();
    for (const CurveGapTerm& term : named.gap.terms) {
        Json one = {{"term", name_of(term.kind)}, {"verdict", name_of(term.verdict)}};
        if (term.sensor) { one["sensor"] = term_json(*term.sensor, unit); }
        if (term.simulation) { one["simulation"] = term_json(*term.simulation, unit); }
        json["terms"].push_back(std::move(one));
    }
    return json;
}

}  // namespace

std::string curve_json(const CurveReport& report) {
    Json json;
    json["schema"] = "gyrolog-analysis/1";
    json["curve"] = {{"name", report.name}, {"reading_error", report.options.reading_error}};
    json["confidence"] = report.options.confidence;
    json["axes"] = Json::object();
    const bool is_gyro = report.unit.sensor == SensorKind::gyro;
    if (!is_gyro) { json["accelerometer"]["axes"] = Json::object(); }
    Json& axes = is_gyro ? json["axes"] : json["accelerometer"]["axes"];
    for (const PrintedCurveReport& curve : report.curves) {
        axes[curve.name] = curve_axis_json(curve, report.unit);
    }
    if (!report.gaps.empty()) {
        json["gaps"] = Json::array();
        for (const NamedCurveGap& gap : report.gaps) { json["gaps"].push_back(gap_json(gap, report.unit)); }
    }
    json["warnings"] = report.warnings;
    return json_text(json);
}

}  // namespace gyrolog
