// The gap summary tells where curves are off.
#pragma once

#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The place of the curve that surprises most, on all axes whose curves of that measure stand out.
Place farthest_place(const std::vector<GapCurve>& curves, const GapReference& reference);

// By measure with a curve that stands out: its place, and how far the curve is off. The largest first.
std::vector<Left> places_that_stand_out(const std::vector<GapCurve>& curves, const GapReference& reference);

}  // namespace gyrolog
