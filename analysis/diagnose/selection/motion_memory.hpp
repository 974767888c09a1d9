// Motion memory is a nonparametric alternative: what a turn leaves behind and that fades in seconds or
// minutes.
#pragma once

#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

namespace gyrolog {

// The alternative is a bias in proportion to the rate, its size or its square about any axis, through a
// first-order low-pass of 1 s to 100 s. A sensor at rest has none.
std::optional<NonparametricFit> find_motion_memory(const Observation& without, const Observation& with);

}  // namespace gyrolog
