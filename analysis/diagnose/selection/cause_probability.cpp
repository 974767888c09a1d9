#include "analysis/diagnose/selection/cause_probability.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// So many rivals are told of.
constexpr std::size_t ties_most = 4;

}  // namespace gyrolog::resolution

namespace gyrolog {

Cause with_probability(const FoundCause& found, const CauseSelection& selection, double returning_nats,
                       const std::optional<BetterShape>& better_shape) {
    const std::string& effect = found.finding.effect;
    Cause cause;
    cause.finding = found.finding;
    // In units of the cause's own likelihood: itself, then nothing, then every rival.
    const double against_nothing_nats =
        traits_of(effect).is_counted ? found.finding.evidence_nats : returning_nats;
    double sum = 1.0 + std::exp(-against_nothing_nats);
    for (const Finding& rival : found.rivals) {
        if (rival.effect == effect) { continue; }
        const double behind =
            found.finding.evidence_nats - selection.null_bias.taken_over_nats(rival, selection.last);
        sum += std::exp(-behind);
        if (behind < decisions.strong_nats && cause.tie_group.size() < resolution::ties_most) {
            cause.tie_group.push_back({rival.effect, behind});
        }
    }
    if (better_shape && std::ranges::count(better_shape->than, effect) > 0) {
        sum += std::exp(better_shape->evidence_nats);
    }
    cause.score = 1.0 / sum;
    if (!cause.tie_group.empty()) {
        cause.tie_group.insert(cause.tie_group.begin(), {effect, 0.0});
        cause.decided_by = find_effect(effect)->signature->decided_by;
    }
    return cause;
}

double probability_of_tie(const Cause& cause) {
    if (cause.tie_group.empty()) { return cause.score; }
    double sum = 0.0;
    for (const Rival& rival : cause.tie_group) {
        sum += cause.score * std::exp(-rival.evidence_below_best_nats);
    }
    return sum;
}

std::string telling_apart(const std::string& effect) { return "to tell " + effect + " from "; }

std::string deciding_recording(const Cause& cause) {
    if (cause.decided_by.empty()) { return {}; }
    const Rival& rival = cause.tie_group[1];
    std::string proposal = telling_apart(cause.finding.effect) + rival.effect + ": " + cause.decided_by;
    // What noise tells grows with the time that it is listened to.
    if (traits_of(cause.finding.effect).is_noise) {
        const double times =
            std::ceil(decisions.certain_nats() / std::max(rival.evidence_below_best_nats, 0.5));
        proposal +=
            ", some " + std::to_string(std::max(2, static_cast<int>(times))) + " times as long as this one";
    }
    return proposal;
}

}  // namespace gyrolog
