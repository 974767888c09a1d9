// A sensor as a model describes it, drawn from what the model leaves open.
#pragma once

#include <cstdint>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// Each noise coefficient times 1 + sd_rel z (never below 0), an axis' own sd_rel before the model's, and the
// time stamps' jitter likewise; M and latency_s plus sd_abs z. z are standard normal, one for each parameter,
// functions of the seed alone. The turn-on bias and the clock's rate stay: the one differs freely from
// recording to recording, the other is read from the recording's own time stamps.
SensorModel draw_within_uncertainty(const SensorModel& model, std::uint64_t seed);

}  // namespace gyrolog
