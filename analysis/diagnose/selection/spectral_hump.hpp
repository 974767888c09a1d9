// An nonparametric alternative: noise whose spectrum rises to a hump and falls again, with any two slopes.
#pragma once

#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

namespace gyrolog {

std::optional<NonparametricFit> find_spectral_hump(const Observation& without, const Observation& with);

}  // namespace gyrolog
