// The report of an Allan analysis as JSON, gyrolog-analysis/1. Rates are in the report's unit,
// accelerations in the accelerometer's. Its axes have "mean" in the place of "bias": gravity is in it.
//   "accelerometer": {"axes": {...}, "gravity": {"size": {"value", "expanded_uncertainty",
//     "coverage_factor", "unit"}, "tilt": {likewise, in deg}, "up": "+z", "direction": [x, y, z]}}
// Of an array, "gravity" has such an object for each unit's number.
// "recording" has "board", "started" and "temperature_C" (the mean) where they are known.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"
#include "host/formats/recording_facts.hpp"

namespace gyrolog {

// Pretty-printed, ending in a newline; numbers read back as the same.
std::string analysis_json(const AnalysisReport& report, const RecordingFacts& facts = {});

}  // namespace gyrolog
