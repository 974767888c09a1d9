// An unspecific rival: noise whose spectrum rises to a hump and falls again, with any two slopes.
#pragma once

#include "analysis/diagnose/selection/unspecific_rivals.hpp"

namespace gyrolog {

std::optional<UnspecificFinding> find_spectral_hump(const Observation& without, const Observation& with);

}  // namespace gyrolog
