// The figure of an analysis.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Draws the report's curves into a PNG file.
Status write_analysis_plot(const AnalysisReport& report, const std::string& path);

}  // namespace gyrolog
