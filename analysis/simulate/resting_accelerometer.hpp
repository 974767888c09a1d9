// The accelerometer of a model, simulated by the simulator of its gyro: the same noise, converter and
// effects, in m/s^2 where a gyro has rad/s.
#pragma once

#include <cstdint>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// A sensor whose simulated rate, in a world whose rates are specific forces (force_world.hpp), is that of the
// model's accelerometer in m/s^2. `model` has an accelerometer.
SensorModel exposed_accelerometer(const SensorModel& model);

// A sensor whose simulated rate, at rest, is the specific force in m/s^2 of the model's accelerometer, its z
// axis upward: its bias is the model's and M times gravity. `model` has an accelerometer.
SensorModel resting_accelerometer(const SensorModel& model);

// Another stream of random numbers than the gyro's of the same seed.
constexpr std::uint64_t accelerometer_seed(std::uint64_t seed) { return seed ^ 0x616363656C657200U; }

}  // namespace gyrolog
