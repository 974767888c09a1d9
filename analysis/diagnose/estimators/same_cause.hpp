// Whether two findings tell of one cause.
#pragma once

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// Two findings of one effect do, unless the effect recurs: then their lines have to lie at one frequency, to
// within what a steady line that wanders or swells leaves beside itself in a recording of `duration_s`, and
// their steps at one instant.
bool is_same_cause(const Finding& a, const Finding& b, double duration_s);

}  // namespace gyrolog
