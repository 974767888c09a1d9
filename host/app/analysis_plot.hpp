// The figures of an analysis.
#pragma once

#include <optional>
#include <string>

#include "analysis/noise/analyze.hpp"
#include "analysis/plot/allan_figure.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Draws the report's curves and spectra into a PNG file.
Status write_analysis_plot(const AnalysisReport& report, const std::string& path);

// Draws how the samples of the axes that the report is about lie around their bias.
Status write_histogram_plot(const AnalysisReport& report, const Recording& recording,
                            const std::string& path);

// For a curve's marks: none where the fit did not identify it.
std::optional<PlottedCoefficient> plotted_coefficient(const NoiseFit& fit, NoiseTerm term);

}  // namespace gyrolog
