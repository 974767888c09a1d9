// The report of an Allan analysis for people: one screen, a column an axis.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"

namespace gyrolog {

// Two significant digits of an uncertainty, and as many decimals of its value.
std::string analysis_text(const AnalysisReport& report);

}  // namespace gyrolog
