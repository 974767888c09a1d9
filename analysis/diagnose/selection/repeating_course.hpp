// The repeating course is a nonparametric alternative: a mean that repeats itself, whatever its shape
// (numerics/repetition.hpp).
#pragma once

#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

namespace gyrolog {

std::optional<NonparametricFit> find_repeating_course(const Observation& without, const Observation& with);

}  // namespace gyrolog
