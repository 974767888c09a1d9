// How the samples of each axis lie about the bias, beside the Gaussian of the same standard deviation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/amplitude/amplitude_histogram.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct HistogramTrace {
    std::string name;  // "x"
    AmplitudeHistogram histogram;
    double expanded_uncertainty = 0.0;  // of the mean, unit of the histogram
    double coverage_factor = 2.0;
};

struct HistogramFigure {
    std::string title = "Samples about the bias";
    std::string source;
    std::vector<std::string> facts;
    std::string unit_name = "°/s";
    double per_unit_of_data = 1.0;
    std::string mean_name = "bias";
    std::vector<HistogramTrace> traces;
    PaperSize paper{};
};

// A panel for each trace, in one column, or in three where there are more than four. The count axis is
// logarithmic: there a Gaussian is a parabola, and tails that a linear axis hides stand beside it.
Figure figure_of(const HistogramFigure& histograms);

Rendering render(const HistogramFigure& histograms);

}  // namespace gyrolog
