#include "analysis/diagnose/estimators/hypotheses.hpp"

#include <utility>

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
    return examine(prediction, std::make_shared<const Observation>(prediction, recording, seed), threads);
}

Hypotheses examine(const std::shared_ptr<const Prediction>& prediction,
                   std::shared_ptr<const Observation> observation, unsigned threads) {
    Hypotheses hypotheses;
    hypotheses.prediction = prediction;
    hypotheses.observation = std::move(observation);
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
                                   const Observation& completed) {
    const MadeEstimator made = make_estimator(*find_effect(effect), prediction);
    return made.estimator ? made.estimator->find(Observation(prediction, completed)) : std::nullopt;
}

}  // namespace gyrolog
