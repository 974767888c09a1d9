// The stages of every sensor, each in a file of its own; sensor_simulator.cpp holds their order.
#pragma once

#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// The sensor's temperature: the model's reference, a slow wander (0.5 degC, half an hour) and the reading's
// own noise. Fills SampleBlock::temperature_C, adds nothing to the rate.
std::unique_ptr<Stage> make_temperature(const StageContext& context);
// Turn-on bias, and the bias that follows the temperature in proportion.
std::unique_ptr<Stage> make_bias(const StageContext& context);
// N: independent samples of standard deviation N sqrt(rate).
std::unique_ptr<Stage> make_white_noise(const StageContext& context);
// B: flicker_noise.hpp.
std::unique_ptr<Stage> make_flicker_noise(const StageContext& context);
// K: a sampled random walk from zero with increments of standard deviation K / sqrt(rate).
std::unique_ptr<Stage> make_rate_random_walk(const StageContext& context);
// R: a rate that grows by R every second.
std::unique_ptr<Stage> make_rate_ramp(const StageContext& context);
// Q: the first difference of independent angle errors of standard deviation Q, times the rate.
std::unique_ptr<Stage> make_angle_quantisation(const StageContext& context);

}  // namespace gyrolog
