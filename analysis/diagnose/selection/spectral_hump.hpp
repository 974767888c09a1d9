// The spectral hump is a nonparametric alternative: noise whose spectrum rises to a hump and falls again,
// with any two slopes, x^rise / (1 + x^(rise + fall)).
#pragma once

#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

namespace gyrolog {

std::optional<NonparametricFit> find_spectral_hump(const Observation& without, const Observation& with);

}  // namespace gyrolog
