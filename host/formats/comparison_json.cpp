#include "host/formats/comparison_json.hpp"

#include "analysis/noise/noise_model.hpp"
#include "host/formats/comparison_text.hpp"
#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

Json in_degrees(const std::vector<double>& rates_rad) {
    Json array = Json::array();
    for (const double rate : rates_rad) { array.push_back(rate * deg_per_rad); }
    return array;
}

Json curve_json(const ComparedCurve& curve, const char* at) {
    Json json;
    json[at] = curve.at;
    json["recording"] = in_degrees(curve.recording);
    if (!curve.recording_lo.empty()) {
        json["recording_lo"] = in_degrees(curve.recording_lo);
        json["recording_hi"] = in_degrees(curve.recording_hi);
    }
    json["other"] = in_degrees(curve.other);
    json["lo"] = in_degrees(curve.lo);
    json["hi"] = in_degrees(curve.hi);
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
    json["axes"] = Json::object();
    for (const AxisComparison& axis : comparison.axes) {
        Json& one = json["axes"][axis.axis];
        one["sentence"] = outcome_sentence(comparison, axis);
        one["allan"] = curve_json(axis.allan, "tau_s");
        one["spectrum"] = curve_json(axis.spectrum, "f_hz");
        one["standard_deviation"] = number_json(axis.standard_deviation, deg_per_rad);
        one["skewness"] = number_json(axis.skewness, 1.0);
        one["excess_kurtosis"] = number_json(axis.excess_kurtosis, 1.0);
    }
    json["notes"] = comparison.notes;
    json["warnings"] = comparison.warnings;
    return json_text(json);
}

}  // namespace gyrolog
