#include "analysis/diagnose/selection/cause_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// So many rivals are told of.
constexpr std::size_t ties_most = 4;
// A rival that is as good as the cause would ask for a recording without end.
constexpr double least_behind_nats = 0.5;

}  // namespace gyrolog::resolution

namespace gyrolog {
namespace {

// In the largest unit of which there are two, rounded up: "40 s", "80 min", "30 h", "5 days".
std::string length_text(double length_s) {
    struct Unit {
        double length_s;
        const char* name;
    };
    constexpr std::array units{Unit{86400.0, " days"}, Unit{3600.0, " h"}, Unit{60.0, " min"},
                               Unit{1.0, " s"}};
    const auto* unit =
        std::ranges::find_if(units, [&](const Unit& one) { return length_s >= 2.0 * one.length_s; });
    if (unit == units.end()) { --unit; }
    return std::to_string(static_cast<long>(std::ceil(length_s / unit->length_s - 1e-9))) + unit->name;
}

}  // namespace

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
    return telling_apart(cause.finding.effect) + cause.tie_group[1].effect + ": " + cause.decided_by;
}

void state_deciding_length(Cause& cause, double duration_s) {
    constexpr std::string_view place = "{length}";
    const std::size_t at = cause.decided_by.find(place);
    if (at == std::string::npos || cause.tie_group.size() < 2) { return; }
    const double behind_nats =
        std::max(cause.tie_group[1].evidence_below_best_nats, resolution::least_behind_nats);
    const double times = std::max(2.0, std::ceil(decisions.certain_nats() / behind_nats));
    cause.decided_by.replace(at, place.size(), length_text(times * duration_s) + " or more");
}

}  // namespace gyrolog
