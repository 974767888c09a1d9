#include "host/formats/comparison_json.hpp"

#include "host/formats/comparison_text.hpp"
#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

Json numbers_json(const std::vector<double>& values, double per_unit) {
    Json array = Json::array();
    for (const double value : values) { array.push_back(value * per_unit); }
    return array;
}

Json curve_json(const ComparedCurve& curve, const char* at, double per_unit) {
    Json json;
    json[at] = curve.at;
    json["recording"] = numbers_json(curve.recording, per_unit);
    if (!curve.recording_lo.empty()) {
        json["recording_lo"] = numbers_json(curve.recording_lo, per_unit);
        json["recording_hi"] = numbers_json(curve.recording_hi, per_unit);
    }
    json["other"] = numbers_json(curve.other, per_unit);
    json["lo"] = numbers_json(curve.lo, per_unit);
    json["hi"] = numbers_json(curve.hi, per_unit);
    json["ratio_dB"] = Json::array();
    for (std::size_t i = 0; i < curve.at.size(); ++i) { json["ratio_dB"].push_back(curve.ratio_dB(i)); }
    json["outside"] = Json::array();
    for (const OutsideRange& range : curve.outside) {
        json["outside"].push_back({{"from", range.from},
                                   {"to", range.to},
                                   {"worst_at", range.worst_at},
                                   {"worst_dB", range.worst_dB},
                                   {"points", range.points}});
    }
    json["points_by_chance"] = curve.points_by_chance;
    if (curve.simulations_outside_as_often) {
        json["simulations_outside_as_often"] = *curve.simulations_outside_as_often;
    }
    json["largest_gap"] = {{"at", curve.gap.at},
                           {"dB", curve.gap.dB},
                           {"distance", curve.gap.distance},
                           {"stands_out", curve.gap.stands_out}};
    return json;
}

Json number_json(const ComparedNumber& number, double per_unit) {
    Json json{{"recording", number.recording * per_unit}, {"other", number.other * per_unit}};
    if (number.lo) {
        json["lo"] = *number.lo * per_unit;
        json["hi"] = *number.hi * per_unit;
        json["distance"] = number.distance;
        json["stands_out"] = number.stands_out;
    }
    return json;
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
    Json json;
    json["schema"] = "gyrolog-compare/1";
    json["recording"] = comparison.recording_name;
    json["other"] = comparison.other_name;
    json["with"] = comparison.simulations > 0 ? "simulations" : "recording";
    if (comparison.simulations > 0) {
        json["simulations"] = comparison.simulations;
        json["seed"] = comparison.seed;
        json["band_probability"] = comparison.band_probability;
    }
    json["rate_hz"] = comparison.rate_hz;
    json["duration_s"] = comparison.duration_s;
    json["samples"] = comparison.samples;
    json["less_reference"] = comparison.less_reference;
    if (comparison.unit.sensor == SensorKind::accelerometer) { json["sensor"] = "accelerometer"; }
    json["axes"] = Json::object();
    const double per_unit = comparison.unit.per_column_unit;
    for (const AxisComparison& axis : comparison.axes) {
        Json& one = json["axes"][axis.axis];
        one["sentence"] = outcome_sentence(comparison, axis);
        one["allan"] = curve_json(axis.allan, "tau_s", per_unit);
        one["spectrum"] = curve_json(axis.spectrum, "f_hz", per_unit);
        one["standard_deviation"] = number_json(axis.standard_deviation, per_unit);
        one["skewness"] = number_json(axis.skewness, 1.0);
        one["excess_kurtosis"] = number_json(axis.excess_kurtosis, 1.0);
    }
    json["notes"] = comparison.notes;
    json["warnings"] = comparison.warnings;
    return json_text(json);
}

}  // namespace gyrolog
