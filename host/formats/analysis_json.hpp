// The report of an Allan analysis as JSON, gyrolog-analysis/1. Rates are in the report's unit.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"

namespace gyrolog {

// Pretty-printed, ending in a newline; numbers read back as the same.
std::string analysis_json(const AnalysisReport& report);

}  // namespace gyrolog
