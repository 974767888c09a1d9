#include "analysis/simulate/effects/effects.hpp"

#include <algorithm>

namespace gyrolog {

std::span<const EffectDefinition> known_effects() {
    static const std::vector<EffectDefinition> effects = {
        {"gauss_markov", {"sigma_dps", "tau_s"}, make_gauss_markov_effect},
        {"bias_step", {"step_dps", "at_s"}, make_bias_step_effect},
        {"rate_ramp", {"ramp_dps_per_s"}, make_rate_ramp_effect},
        {"tone", {"f_hz", "amplitude_dps", "phase_rad"}, make_tone_effect},
    };
    return effects;
}

const EffectDefinition* find_effect(std::string_view name) {
    for (const EffectDefinition& effect : known_effects()) {
        if (effect.name == name) { return &effect; }
    }
    return nullptr;
}

std::optional<std::string> effect_refusal(const EffectModel& effect) {
    const EffectDefinition* definition = find_effect(effect.effect);
    if (definition == nullptr) {
        return "effect '" + effect.effect + "' cannot be simulated by this version";
    }
    for (const std::string_view param : definition->params) {
        if (!effect.params.contains(std::string(param))) {
            return "effect '" + effect.effect + "' lacks its parameter '" + std::string(param) + "'";
        }
    }
    for (const std::string& axis : effect.axes) {
        if (std::find(axis_names.begin(), axis_names.end(), axis) == axis_names.end()) {
            return "effect '" + effect.effect + "' names an axis '" + axis + "' that is not x, y or z";
        }
    }
    return std::nullopt;
}

bool acts_on(const EffectModel& effect, std::size_t axis) {
    return std::find(effect.axes.begin(), effect.axes.end(), axis_names[axis]) != effect.axes.end();
}

}  // namespace gyrolog
