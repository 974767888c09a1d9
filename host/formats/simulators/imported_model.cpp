#include "host/formats/simulators/imported_model.hpp"

#include <charconv>
#include <cmath>

#include "host/base/printable.hpp"

namespace gyrolog {

std::optional<double> finite_number(std::string_view text) {
    constexpr const char* blanks = " \t\r\n";
    const std::size_t from = text.find_first_not_of(blanks);
    if (from == std::string_view::npos) { return std::nullopt; }
    text = text.substr(from, text.find_last_not_of(blanks) + 1 - from);
    if (text.starts_with('+')) { text.remove_prefix(1); }
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

ModelFile nothing_stated() {
    ModelFile file;
    file.model.rate_hz = 0.0;
    file.model.full_scale_rad_s = no_range_rad_s;
    file.model.saturation_rad_s = no_range_rad_s;
    file.unstated = {true, true, true, true};
    return file;
}

void state_range(ModelFile& file, double full_scale_rad_s) {
    file.model.full_scale_rad_s = full_scale_rad_s;
    file.model.saturation_rad_s = full_scale_rad_s;
    file.unstated.full_scale = false;
    file.unstated.saturation = false;
}

void state_step(ModelFile& file, double lsb_rad_s) {
    file.model.lsb_rad_s = lsb_rad_s;
    file.unstated.step = false;
}

GaussMarkov driven_gauss_markov(double drive_rad_per_s_sqrt_s, double correlation_s) {
    return {drive_rad_per_s_sqrt_s * std::sqrt(correlation_s / 2.0), correlation_s};
}

void add_gauss_markov(SensorModel& model, const std::array<GaussMarkov, 3>& of_axes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const GaussMarkov& process = of_axes[axis];
        if (process.sigma_rad_per_s == 0.0) { continue; }
        const double sigma_dps = process.sigma_rad_per_s * deg_per_rad;
        bool joined = false;
        for (EffectModel& effect : model.effects) {
            if (effect.effect != "gauss_markov" || effect.params.at("sigma_dps") != sigma_dps ||
                effect.params.at("tau_s") != process.correlation_s) {
                continue;
            }
            effect.axes.emplace_back(axis_names[axis]);
            joined = true;
        }
        if (joined) { continue; }
        model.effects.push_back({.effect = "gauss_markov",
                                 .axes = {axis_names[axis]},
                                 .params = {{"sigma_dps", sigma_dps}, {"tau_s", process.correlation_s}},
                                 .carried_json = ""});
    }
}

double StatedNumbersAsText::number(std::string_view text, const std::string& where, Range range) {
    const std::optional<double> value = finite_number(text);
    if (!value) {
        constexpr std::size_t shown_most = 40;
        const bool is_macro = text.find("${") != std::string_view::npos;
        fail(where, "is '" + printable(text.substr(0, shown_most)) + "', which is no finite number" +
                        (is_macro ? ": let xacro write the file out first" : ""));
        return 0.0;
    }
    if (range == Range::positive && *value <= 0.0) { fail(where, "is not above zero"); }
    if (range == Range::not_negative && *value < 0.0) { fail(where, "is below zero"); }
    return *value;
}

void StatedNumbersAsText::fail(const std::string& where, const std::string& what) {
    if (!problem_) { problem_ = where + " " + what; }
}

}  // namespace gyrolog
