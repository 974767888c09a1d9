// The gap summary tells how far the curves are off, and where.
#pragma once

#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct GapSummary {
    Gap gap;      // of the curve that is furthest off
    Place where;  // of that curve
};

// The gap is the distance of the curve that surprises most, with its 95 % interval: that of the root of a
// noncentral chi-square with as many degrees of freedom as the curve has points.
GapSummary summarise(const std::vector<GapCurve>& curves, const GapReference& reference);

}  // namespace gyrolog
