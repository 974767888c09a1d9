// An unspecific rival: a mean that repeats itself, whatever its shape.
#pragma once

#include "analysis/diagnose/selection/unspecific_rivals.hpp"

namespace gyrolog {

std::optional<UnspecificFinding> find_repeating_course(const Observation& without, const Observation& with);

}  // namespace gyrolog
