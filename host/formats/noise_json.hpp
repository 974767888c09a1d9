// The parts of gyrolog-analysis/1 that describe a noise fit, whatever it was fitted to.
#pragma once

#include "analysis/noise/analyze.hpp"
#include "analysis/noise/slope_reading.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {

// "method", "coefficients", "correlation" (of identified terms, where it is known), "gauss_markov",
// "sinusoids". Sizes are in `unit`.
void put_noise_fit(Json& json, const NoiseFit& fit, const SensorUnit& unit);

Json slopes_json(const SlopeReading& slopes, const SensorUnit& unit);

// A report, pretty-printed, ending in a newline. It gains the key "reported_by", with program_name().
std::string json_text(Json report);

}  // namespace gyrolog
