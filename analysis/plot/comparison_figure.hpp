// A recording beside its simulations, or beside another recording: two rows of panels for each axis.
//
//   the recording over time | one simulation, same scale    | both distributions about the mean
//   Allan deviations        | spectra (root of the density) | recording over simulations in dB, by tau
#pragma once

#include "analysis/compare/comparison.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct ComparisonFigure {
    const Comparison& comparison;
    std::vector<std::string> facts;
    PaperSize paper{};
};

Figure figure_of(const ComparisonFigure& comparison);

Rendering render(const ComparisonFigure& comparison);

}  // namespace gyrolog
