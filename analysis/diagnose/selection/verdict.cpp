#include "analysis/diagnose/selection/verdict.hpp"

#include <algorithm>

#include "analysis/diagnose/selection/cause_probability.hpp"

namespace gyrolog::definition {

// The contract of the answer, gyrolog-diagnosis/2. Less is left of the gap's square where it is called known,
// and a cause closes more where it is called known in part.
constexpr double small_share = 0.1;
// The same contract: a cause that is less likely right, with its ties, is a guess only.
constexpr double named_from_probability = 0.5;

}  // namespace gyrolog::definition

namespace gyrolog {

Verdict verdict_of(std::span<const Cause> causes, bool leaves_nothing, double shrink) {
    const auto is_named = [&](const Cause& cause) {
        return probability_of_tie(cause) >= definition::named_from_probability;
    };
    const auto explains = [&](const Cause& cause) {
        return is_named(cause) && cause.share.value >= definition::small_share;
    };
    double doubted_share = 0.0;
    for (const Cause& cause : causes) {
        if (!is_named(cause)) { doubted_share += std::max(cause.share.value, 0.0); }
    }
    const bool is_closed = shrink > 1.0 - definition::small_share;
    // `partly` would claim that more is left. A cause's own probability tells how sure it is.
    if (is_closed && std::ranges::any_of(causes, explains)) { return Verdict::known; }
    if ((is_closed || leaves_nothing) && std::ranges::any_of(causes, is_named) &&
        doubted_share < definition::small_share) {
        return Verdict::known;
    }
    return std::ranges::any_of(causes, explains) ? Verdict::partly : Verdict::unexplained;
}

}  // namespace gyrolog
