#include "host/formats/filter_tuning_json.hpp"

#include <cmath>
#include <numbers>

#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

// Of a Gauss-Markov process with sigma and T of 1.
constexpr double peak_tau = 1.8925;
const double peak_deviation = std::sqrt(GaussMarkov{1.0, 1.0}.allan_variance(peak_tau));

Json absent(const ExportedTerm& term, const char* unit) {
    Json json = {{"state", "not_identifiable"}};
    if (term.upper) { json["upper"] = *term.upper; }
    json["unit"] = unit;
    return json;
}

Json white_json(const ExportedTerm& N, double dt_s) {
    if (!N.identified) { return absent(N, "rad/sqrt(s)"); }
    return {{"state", "identified"},
            {"continuous",
             {{"N", N.value}, {"unit", "rad/sqrt(s)"}, {"psd", N.value * N.value}, {"psd_unit", "rad^2/s"}}},
            {"discrete",
             {{"Q_angle", N.value * N.value * dt_s},
              {"unit", "rad^2"},
              {"rate_sd", N.value / std::sqrt(dt_s)},
              {"rate_sd_unit", "rad/s"}}}};
}

Json walk_json(const ExportedTerm& K, double dt_s) {
    if (!K.identified) { return absent(K, "rad/s^1.5"); }
    return {{"state", "identified"},
            {"continuous",
             {{"K", K.value}, {"unit", "rad/s^1.5"}, {"psd", K.value * K.value}, {"psd_unit", "rad^2/s^3"}}},
            {"discrete",
             {{"Q_bias", K.value * K.value * dt_s},
              {"unit", "rad^2/s^2"},
              {"bias_step_sd", K.value * std::sqrt(dt_s)},
              {"bias_step_sd_unit", "rad/s"}}}};
}

Json matrix_json(const ExportedAxis& axis, double dt_s) {
    const double white = axis.N.value * axis.N.value;
    const double walk = axis.K.value * axis.K.value;
    const double cross = -walk * dt_s * dt_s / 2.0;
    return {
        {"states", {"angle", "bias"}},
        {"Q", {{white * dt_s + walk * dt_s * dt_s * dt_s / 3.0, cross}, {cross, walk * dt_s}}},
        {"unit", Json::array({Json::array({"rad^2", "rad^2/s"}), Json::array({"rad^2/s", "rad^2/s^2"})})}};
}

// Where the Allan curve is flat: as it was read, or where white noise and random walk together are lowest.
std::optional<double> flat_tau_s(const ExportedAxis& axis) {
    if (axis.N.identified && axis.K.identified) { return std::sqrt(3.0) * axis.N.value / axis.K.value; }
    return axis.flat_tau_s;
}

Json flicker_json(const ExportedAxis& axis, double dt_s) {
    const auto tau_s = flat_tau_s(axis);
    if (!axis.B.identified) { return absent(axis.B, "rad/s"); }
    Json json = {{"state", "identified"}, {"B", axis.B.value}, {"unit", "rad/s"}};
    if (!tau_s) {
        json["gauss_markov"] = nullptr;
        json["why"] = "the Allan curve has no flat to which a correlation time could be matched";
        return json;
    }
    const double sigma =
        axis.B.value * std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi) / peak_deviation;
    const double correlation_s = *tau_s / peak_tau;
    const double phi = std::exp(-dt_s / correlation_s);
    json["gauss_markov"] = {
        {"rule", "maximum of its Allan deviation at the flat of the curve, in height and averaging time"},
        {"flat_tau_s", *tau_s},
        {"sigma", sigma},
        {"correlation_s", correlation_s},
        {"continuous", {{"psd_of_drive", 2.0 * sigma * sigma / correlation_s}, {"unit", "rad^2/s^3"}}},
        {"discrete",
         {{"phi", phi},
          {"Q", -sigma * sigma * std::expm1(-2.0 * dt_s / correlation_s)},
          {"unit", "rad^2/s^2"}}}};
    return json;
}

}  // namespace

std::string filter_tuning_json(const ExportSource& source) {
    const double dt_s = 1.0 / source.rate_hz;
    Json json;
    json["schema"] = "gyrolog-filter-tuning/1";
    json["source"] = source.name;
    json["rate_hz"] = source.rate_hz;
    json["dt_s"] = dt_s;
    json["process"] = "d(angle)/dt = measured rate - bias; d(bias)/dt = drive";
    for (const std::string& warning : warnings_of(source)) { json["warnings"].push_back(warning); }
    json["axes"] = Json::object();
    for (const ExportedAxis& axis : source.gyro) {
        Json& one = json["axes"][axis.name];
        one["white_rate_noise"] = white_json(axis.N, dt_s);
        one["rate_random_walk"] = walk_json(axis.K, dt_s);
        if (axis.N.identified && axis.K.identified) { one["angle_and_bias"] = matrix_json(axis, dt_s); }
        one["bias_instability"] = flicker_json(axis, dt_s);
    }
    return json_text(json);
}

}  // namespace gyrolog
