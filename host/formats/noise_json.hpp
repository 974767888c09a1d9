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

// A report, pretty-printed, ending in a newline. It gains the key "reported_by", with program_name().
std::string json_text(nlohmann::ordered_json report);

}  // namespace gyrolog
