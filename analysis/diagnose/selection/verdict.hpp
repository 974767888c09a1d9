// The verdict tells what of the gap the causes explain.
#pragma once

#include <span>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// Of a recording that has a gap. `leaves_nothing`: chance leaves as much as the causes do. `shrink` is the
// share of the gap's square that they close. Where next to nothing is left and a likely cause closes a tenth,
// the verdict is `known`, as the answer's contract has it. Else a cause that is doubted takes nothing from
// the others as long as the doubted ones together have a small share.
Verdict verdict_of(std::span<const Cause> causes, bool leaves_nothing, double shrink);

}  // namespace gyrolog
