// The figure of printed curves with their models.
#pragma once

#include <string>

#include "analysis/noise/curve_report.hpp"
#include "analysis/plot/paper_size.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Draws the curves and the models fitted to them into a PNG file.
Status write_curve_plot(const CurveReport& report, const PaperSize& paper, const std::string& path);

}  // namespace gyrolog
