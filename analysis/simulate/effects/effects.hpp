// The effects by name, for the chain. Each is defined, and explained, in its file.
#pragma once

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

extern const EffectDefinition angle_noise_effect;
extern const EffectDefinition arw_scale_effect;
extern const EffectDefinition asymmetry_effect;
extern const EffectDefinition bias_step_effect;
extern const EffectDefinition biquad_effect;
extern const EffectDefinition clock_jitter_effect;
extern const EffectDefinition clock_rate_effect;
extern const EffectDefinition common_mode_effect;
extern const EffectDefinition dead_zone_effect;
extern const EffectDefinition density_table_effect;
extern const EffectDefinition disturbance_effect;
extern const EffectDefinition dropped_effect;
extern const EffectDefinition flicker_missing_effect;
extern const EffectDefinition g_sensitivity_effect;
extern const EffectDefinition gauss_markov_effect;
extern const EffectDefinition heavy_tail_effect;
extern const EffectDefinition latency_effect;
extern const EffectDefinition lowpass_effect;
extern const EffectDefinition misalignment_effect;
extern const EffectDefinition nonlinearity_effect;
extern const EffectDefinition narrowband_effect;
extern const EffectDefinition noise_colour_effect;
extern const EffectDefinition quantization_effect;
extern const EffectDefinition rate_ramp_effect;
extern const EffectDefinition rate_table_effect;
extern const EffectDefinition rrw_missing_effect;
extern const EffectDefinition rtn_effect;
extern const EffectDefinition saturation_effect;
extern const EffectDefinition scale_factor_effect;
extern const EffectDefinition self_heating_effect;
extern const EffectDefinition spikes_effect;
extern const EffectDefinition stale_effect;
extern const EffectDefinition temp_cubic_effect;
extern const EffectDefinition temp_lag_effect;
extern const EffectDefinition temp_linear_effect;
extern const EffectDefinition temp_noise_effect;
extern const EffectDefinition temp_quadratic_effect;
extern const EffectDefinition temp_scale_effect;
extern const EffectDefinition temperature_table_effect;
extern const EffectDefinition time_table_effect;
extern const EffectDefinition level_table_effect;
extern const EffectDefinition tone_effect;
extern const EffectDefinition variance_change_effect;
extern const EffectDefinition vibration_rectification_effect;
extern const EffectDefinition warmup_effect;

}  // namespace gyrolog
