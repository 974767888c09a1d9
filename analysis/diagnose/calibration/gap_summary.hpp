// Gap curves summed up: how far, and where.
#pragma once

#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct GapSummary {
    Gap gap;      // of the curve that is furthest off
    Place where;  // of that curve
};

GapSummary summarise(const std::vector<GapCurve>& curves, const GapReference& reference);

}  // namespace gyrolog
