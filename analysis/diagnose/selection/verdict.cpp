#include "analysis/diagnose/selection/verdict.hpp"

#include <algorithm>

#include "analysis/diagnose/selection/cause_probability.hpp"

namespace gyrolog {

Verdict verdict_of(std::span<const Cause> causes, bool leaves_nothing, double shrink,
                   const VerdictOptions& options) {
    const auto is_named = [&](const Cause& cause) {
        return probability_of_tie(cause) >= options.named_from_probability;
    };
    const auto explains = [&](const Cause& cause) {
        return is_named(cause) && cause.share.value >= options.small_share;
    };
    double doubted_share = 0.0;
    for (const Cause& cause : causes) {
        if (!is_named(cause)) { doubted_share += std::max(cause.share.value, 0.0); }
    }
    const bool is_closed = leaves_nothing || shrink > 1.0 - options.small_share;
    if (is_closed && std::ranges::any_of(causes, is_named) && doubted_share < options.small_share) {
        return Verdict::known;
    }
    return std::ranges::any_of(causes, explains) ? Verdict::partly : Verdict::unexplained;
}

}  // namespace gyrolog
