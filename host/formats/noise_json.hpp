// The parts of gyrolog-analysis/1 that describe a noise fit, whatever it was fitted to.
#pragma once

#include <nlohmann/json.hpp>

#include "analysis/noise/analyze.hpp"
#include "analysis/noise/slope_reading.hpp"

namespace gyrolog {

// "method", "coefficients", "correlation" (of identified terms, where it is known), "gauss_markov",
// "sinusoids". Sizes are in `unit`.
void put_noise_fit(nlohmann::ordered_json& json, const NoiseFit& fit, const RateUnit& unit);

nlohmann::ordered_json slopes_json(const SlopeReading& slopes, const RateUnit& unit);

// Pretty-printed, ending in a newline.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace gyrolog
