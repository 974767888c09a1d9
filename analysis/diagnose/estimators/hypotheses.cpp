#include "analysis/diagnose/estimators/hypotheses.hpp"

#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

const Finding* Hypotheses::best() const {
    const Finding* best = nullptr;
    for (const std::optional<Finding>& finding : findings) {
        if (finding && (best == nullptr || finding->evidence_nats > best->evidence_nats)) {
            best = &*finding;
        }
    }
    return best;
}

Hypotheses examine(const std::shared_ptr<const Prediction>& prediction,
                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed, unsigned threads) {
    Hypotheses hypotheses;
    hypotheses.prediction = prediction;
    hypotheses.observation = std::make_shared<const Observation>(prediction, recording, seed);
    hypotheses.catalogue = make_catalogue(prediction, threads);
    hypotheses.findings.resize(hypotheses.catalogue.size());
    parallel_for(hypotheses.catalogue.size(), threads, [&](std::size_t i) {
        if (hypotheses.catalogue[i].estimator) {
            hypotheses.findings[i] = hypotheses.catalogue[i].estimator->find(*hypotheses.observation);
        }
    });
    return hypotheses;
}

std::optional<Finding> examine_for(std::string_view effect,
                                   const std::shared_ptr<const Prediction>& prediction,
                                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed) {
    const MadeEstimator made = make_estimator(*find_effect(effect), prediction);
    return made.estimator ? made.estimator->find(Observation(prediction, recording, seed)) : std::nullopt;
}

}  // namespace gyrolog
