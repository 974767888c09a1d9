// A diagnosis in one picture. On top the bars of shares, where there is a gap. Below,
// for each axis and each way of looking, the recording over the band of simulations, before (light,
// broken edge) and after the causes were added to the model (dark, whole edge). Points outside the first band
// are marked by disks, those outside the second, where there is one, by diamonds.
//
// One column for each axis and one row for each way of looking: those that stand out most, before or after,
// six or as many as a page holds; those that some axis lacks follow each other at the end. What has a
// logarithmic scale is shown over the middle of the first band, in dB of the quantity: a gap of one decibel
// would not be seen on a curve of three decades.
#pragma once

#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct DiagnosisFigure {
    const Diagnosis& diagnosis;
    std::string title;               // the verdict
    std::vector<std::string> facts;  // follow the names of recording and model
    PaperSize paper{};
};

Figure figure_of(const DiagnosisFigure& diagnosis);

Rendering render(const DiagnosisFigure& diagnosis);

}  // namespace gyrolog
