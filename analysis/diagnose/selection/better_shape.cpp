#include "analysis/diagnose/selection/better_shape.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"
#include "analysis/parallel/parallel_for.hpp"

namespace gyrolog {

namespace {

// Causes for which a shape may stand together.
using CauseGroup = std::vector<const FoundCause*>;

std::vector<CauseGroup> groups_of(const std::vector<FoundCause>& causes) {
    std::vector<CauseGroup> groups;
    CauseGroup in_spectra;
    for (const FoundCause& cause : causes) {
        groups.push_back({&cause});
        if (!traits_of(cause.finding.effect).is_beside_spectra) { in_spectra.push_back(&cause); }
    }
    // Without any, a shape stands beside the model alone.
    if (in_spectra.size() != 1) { groups.push_back(std::move(in_spectra)); }
    return groups;
}

struct Worth {
    double gain_nats = 0.0;
    double evidence_nats = 0.0;
};

// `together_nats`: what the spectra's likelihood gains by all of them beside the other causes. One that was
// found before those had less; what tails or codes gain is not in the spectra. Of other samples the
// likelihood does not compare.
Worth worth_of(const CauseGroup& causes, const NullBias& null_bias, double together_nats) {
    Worth worth;
    bool compares = true;
    for (const FoundCause* cause : causes) {
        worth.gain_nats += cause->finding.gain_nats;
        worth.evidence_nats += cause->finding.evidence_nats + null_bias.of(cause->finding);
        compares = compares && !traits_of(cause->finding.effect).changes_likelihood;
    }
    const double cost_nats = worth.gain_nats - worth.evidence_nats;
    if (compares && together_nats > worth.gain_nats) { worth = {together_nats, together_nats - cost_nats}; }
    return worth;
}

SensorModel model_without(const CauseSelection& selection, const CauseGroup& left_out) {
    SensorModel model = selection.without_causes;
    for (const FoundCause& cause : selection.causes) {
        if (std::ranges::count(left_out, &cause) == 0) {
            model = with_cause(std::move(model), cause.finding);
        }
    }
    return model;
}

}  // namespace

std::optional<BetterShape> better_shape(const CauseSelection& selection,
                                        const std::shared_ptr<const Prediction>& given,
                                        const std::shared_ptr<const Recording>& recording,
                                        const ShapeOptions& options) {
    const std::vector<CauseGroup> groups = groups_of(selection.causes);
    const Observation with(given->with(model_without(selection, {})), recording, options.seed);
    std::vector<std::optional<BetterShape>> better(groups.size());
    parallel_for(groups.size(), options.threads, [&](std::size_t i) {
        const Observation left(given->with(model_without(selection, groups[i])), with);
        const std::optional<NonparametricFit> shape = best_nonparametric(left, with);
        if (!shape) { return; }
        const double together_nats = log_likelihood_nats(with) - log_likelihood_nats(left);
        const Worth causes = worth_of(groups[i], selection.null_bias, together_nats);
        const double more_nats = shape->evidence_nats - causes.evidence_nats;
        if (more_nats < std::max(options.wins_nats, options.wins_share * causes.gain_nats)) { return; }
        std::vector<std::string> than;
        for (const FoundCause* cause : groups[i]) { than.push_back(cause->finding.effect); }
        better[i] = BetterShape{shape->words, std::move(than), more_nats};
    });
    const auto best = std::ranges::max_element(
        better, {}, [](const std::optional<BetterShape>& one) { return one ? one->evidence_nats : 0.0; });
    return best == better.end() ? std::nullopt : std::move(*best);
}

}  // namespace gyrolog
