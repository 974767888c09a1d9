#include "analysis/simulate/accelerometer_effect.hpp"

#include <string_view>

#include "analysis/simulate/effect.hpp"

namespace gyrolog {
namespace {

// The name with one unit, which stands behind a '_' and ends there or before the next, in place of the other.
// Empty: the name has no such unit.
std::string renamed(const std::string& name, std::string_view unit, std::string_view other) {
    const std::string ending = "_" + std::string(unit);
    const std::size_t at = name.find(ending);
    const std::size_t end = at + ending.size();
    if (at == std::string::npos || (end < name.size() && name[end] != '_')) { return {}; }
    return name.substr(0, at) + "_" + std::string(other) + name.substr(end);
}

EffectModel converted(const EffectModel& effect, std::string_view unit, std::string_view other,
                      double factor) {
    EffectModel result = effect;
    result.params.clear();
    result.table.clear();
    for (const auto& [name, value] : effect.params) {
        const std::string known = renamed(name, unit, other);
        result.params[known.empty() ? name : known] = known.empty() ? value : value * factor;
    }
    for (const auto& [name, values] : effect.table) {
        const std::string known = renamed(name, unit, other);
        std::vector<double>& column = result.table[known.empty() ? name : known] = values;
        if (known.empty()) { continue; }
        for (double& value : column) { value *= factor; }
    }
    return result;
}

// The names of parameters in a text, all of them: what else is in it has no unit at its end.
std::string in_accelerometer_names(std::string text) {
    constexpr std::string_view gyro_unit = "_dps";
    for (std::size_t at = text.find(gyro_unit); at != std::string::npos; at = text.find(gyro_unit, at)) {
        text.replace(at, gyro_unit.size(), "_g");
    }
    return text;
}

std::optional<std::string> refusal_of_gyro_name(const std::string& effect, const std::string& name) {
    const std::string meant = accelerometer_param_name(name);
    if (meant.empty()) { return std::nullopt; }
    return "effect '" + effect + "' has no parameter '" + name + "', which is of a gyro; it has " + meant;
}

}  // namespace

EffectModel as_gyro_effect(const EffectModel& of_accelerometer, double rad_s_per_m_s2) {
    return converted(of_accelerometer, "g", "dps", dps_per_g(rad_s_per_m_s2));
}

EffectModel as_accelerometer_effect(const EffectModel& of_gyro, double rad_s_per_m_s2) {
    return converted(of_gyro, "dps", "g", 1.0 / dps_per_g(rad_s_per_m_s2));
}

std::optional<std::string> accelerometer_effect_refusal(const EffectModel& of_accelerometer) {
    for (const auto& given : of_accelerometer.params) {
        if (auto refusal = refusal_of_gyro_name(of_accelerometer.effect, given.first)) { return refusal; }
    }
    for (const auto& given : of_accelerometer.table) {
        if (auto refusal = refusal_of_gyro_name(of_accelerometer.effect, given.first)) { return refusal; }
    }
    const auto refusal = effect_refusal(as_gyro_effect(of_accelerometer, 1.0));
    return refusal ? std::optional(in_accelerometer_names(*refusal)) : std::nullopt;
}

std::string accelerometer_param_name(const std::string& of_gyro) { return renamed(of_gyro, "dps", "g"); }

}  // namespace gyrolog
