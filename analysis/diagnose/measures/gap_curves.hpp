// All measures of an observation.
#pragma once

#include <vector>

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

// The function returns the same curves, of as many points, for every observation of one prediction.
std::vector<GapCurve> gap_curves(const Observation& observation);

// Whether two observations' curves are the same numbers of each, to be held against each other.
bool are_alike(const GapCurve& a, const GapCurve& b);

}  // namespace gyrolog
