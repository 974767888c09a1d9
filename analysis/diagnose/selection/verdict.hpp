// The verdict tells what of the gap the causes explain.
#pragma once

#include <span>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct VerdictOptions {
    // Less is left of the gap's square where it is called known, and a cause closes more where it is called
    // known in part.
    double small_share = 0.1;
    // A cause that is less likely right, with its ties, is named as a guess only.
    double named_from_probability = decisions.majority;
};

// Of a recording that has a gap. `leaves_nothing`: chance leaves as much as the causes do. `shrink` is the
// share of the gap's square that they close. A cause that is doubted takes nothing from the others, as long
// as the doubted ones together have a small share.
Verdict verdict_of(std::span<const Cause> causes, bool leaves_nothing, double shrink,
                   const VerdictOptions& options = {});

}  // namespace gyrolog
