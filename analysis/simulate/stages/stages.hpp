// The stages of every sensor, each in a file of its own; the chain (chain.cpp) holds their order.
#pragma once

#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// Sample k is taken at k / rate, shows the world latency_s before, and its stamp has the model's jitter.
std::unique_ptr<Stage> make_sample_clock(const StageContext& context);
// True rate, specific force and temperature at the moments that the samples show, in the sensor's axes
// (SensorModel::orientation). Without a world: at rest, z upward, the temperature wandering slowly about the
// model's reference (0.5 degC, half an hour).
std::unique_ptr<Stage> make_world(const StageContext& context);
// Scale and misalignment: M times the model's relative misalignment.
std::unique_ptr<Stage> make_rate_response(const StageContext& context);
// Turn-on bias, and the bias that follows the temperature in proportion.
std::unique_ptr<Stage> make_bias(const StageContext& context);
// N: independent samples of standard deviation N sqrt(rate), into SampleBlock::white_rad_s.
std::unique_ptr<Stage> make_white_noise(const StageContext& context);
// B: flicker_noise.hpp.
std::unique_ptr<Stage> make_flicker_noise(const StageContext& context);
// K: a sampled random walk from zero with increments of standard deviation K / sqrt(rate).
std::unique_ptr<Stage> make_rate_random_walk(const StageContext& context);
// R: a rate that grows by R every second.
std::unique_ptr<Stage> make_rate_ramp(const StageContext& context);
// Q: the first difference of independent angle errors of standard deviation Q, times the rate.
std::unique_ptr<Stage> make_angle_quantisation(const StageContext& context);
// The white noise joins the rest.
std::unique_ptr<Stage> make_noise_sum(const StageContext& context);
// The scale factor's change with temperature, for signal and noise.
std::unique_ptr<Stage> make_temperature_scale(const StageContext& context);
// The temperature as the sensor reports it: with the model's temp_noise_C.
std::unique_ptr<Stage> make_thermometer(const StageContext& context);

}  // namespace gyrolog
