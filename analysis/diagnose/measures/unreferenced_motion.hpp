// Without a reference rate, what turned is all noise to a diagnosis.
#pragma once

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

// The function tells whether the rates of a recording without a reference stray from second to second far
// more than noise does: no drift is so fast, no vibration so slow.
bool seems_to_have_turned(const Observation& observation);

}  // namespace gyrolog
