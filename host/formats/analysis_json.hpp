// The report of an Allan analysis as JSON, gyrolog-analysis/1. Rates are in the report's unit,
// accelerations in the accelerometer's. Its axes have "mean" in the place of "bias": gravity is in it.
//   "accelerometer": {"axes": {...}, "gravity": {"size": {"value", "expanded_uncertainty",
//     "coverage_factor", "unit"}, "tilt": {likewise, in deg}, "up": "+z", "direction": [x, y, z]}}
// Of an array, "gravity" has such an object for each unit's number.
// Where the recording has a temperature that varies, an axis has how its bias follows it
// (analysis/noise/temperature_drift.hpp):
//   "temperature": {"state": "identified" | "not_identifiable", "coefficient": {"value", "sd", "unit"},
//     "chance": that a coefficient of 0 looks as large, "false_alarm": at most which it is identified,
//     "taken_off": of allan, coefficients and the rest, "from_C", "to_C", "reference_C": where the bias is
//     the mean, "K_left_in": {"value", "unit"} of the drift left in, "K_taken_off": likewise beside it}
// "recording" has "board", "started" and "temperature_C" (the mean) where they are known.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"
#include "host/formats/recording_facts.hpp"

namespace gyrolog {

// Pretty-printed, ending in a newline; numbers read back as the same.
std::string analysis_json(const AnalysisReport& report, const RecordingFacts& facts = {});

}  // namespace gyrolog
