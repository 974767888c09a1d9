// The figures of an analysis.
#pragma once

#include <optional>
#include <string>

#include "analysis/noise/analyze.hpp"
#include "analysis/plot/allan_figure.hpp"
#include "analysis/plot/histogram_figure.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// The curves and spectra of one sensor of the report, which has it, and how the samples of its axes lie
// around their bias, an accelerometer's around their mean. Of a recording in motion the facts say so.
AllanFigure analysis_figure(const AnalysisReport& report, SensorKind sensor);
HistogramFigure samples_figure(const AnalysisReport& report, const Recording& recording, SensorKind sensor);

// Draws these curves and spectra into a file.
Status write_analysis_plot(const AnalysisReport& report, SensorKind sensor, const PaperSize& paper,
                           const std::string& path);

// Draws how the samples of its axes lie around their bias, an accelerometer's around their mean.
Status write_histogram_plot(const AnalysisReport& report, const Recording& recording, SensorKind sensor,
                            const PaperSize& paper, const std::string& path);

// What the fit has beside the five coefficients.
void add_shaped_terms(AllanTrace& trace, const NoiseFit& fit);

// For a curve's marks: none where the fit did not identify it.
std::optional<PlottedCoefficient> plotted_coefficient(const NoiseFit& fit, NoiseTerm term);

}  // namespace gyrolog
