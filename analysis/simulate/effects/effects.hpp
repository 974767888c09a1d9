// The effects that a model may list under "effects": one file each, one line each in effects.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/simulate/stage.hpp"

namespace gyrolog {

struct EffectDefinition {
    std::string_view name;                 // as in the list of effect names
    std::vector<std::string_view> params;  // all needed; units in their names
    std::unique_ptr<Stage> (*make)(const StageContext&, const EffectModel&);
};

std::span<const EffectDefinition> known_effects();
const EffectDefinition* find_effect(std::string_view name);

// Why the effect cannot be simulated: an unknown name, axis or missing parameter. Empty when it can.
std::optional<std::string> effect_refusal(const EffectModel& effect);

// True when the effect names this axis.
bool acts_on(const EffectModel& effect, std::size_t axis);

// gauss_markov: first-order Gauss-Markov noise of standard deviation `sigma_dps` and correlation time
// `tau_s`, stationary from the first sample.
std::unique_ptr<Stage> make_gauss_markov_effect(const StageContext& context, const EffectModel& effect);
// bias_step: `step_dps` more from `at_s` on.
std::unique_ptr<Stage> make_bias_step_effect(const StageContext& context, const EffectModel& effect);
// rate_ramp: `ramp_dps_per_s`, from zero at the first sample.
std::unique_ptr<Stage> make_rate_ramp_effect(const StageContext& context, const EffectModel& effect);
// tone: `amplitude_dps` sin(2 pi `f_hz` t + `phase_rad`), t from the first sample; above half the rate it
// appears folded, as in a recording.
std::unique_ptr<Stage> make_tone_effect(const StageContext& context, const EffectModel& effect);

}  // namespace gyrolog
