// The effects by name, for the chain. Each is defined, and explained, in its file.
#pragma once

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

extern const EffectDefinition bias_step_effect;
extern const EffectDefinition gauss_markov_effect;
extern const EffectDefinition rate_ramp_effect;
extern const EffectDefinition tone_effect;

}  // namespace gyrolog
