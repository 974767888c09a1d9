// The estimators by the method that an effect's signature names, one line each.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

struct CatalogueEntry {
    const EffectDefinition* effect = nullptr;
    std::unique_ptr<Estimator> estimator;
    std::string untestable;  // why there is no estimator
};

// By which an effect is looked for: in a moving world the mean answer tells far more than the noise does.
EvidenceMethod evidence_method(const EffectSignature& signature, const Prediction& prediction);

// Of one effect; without an estimator and a reason where nothing looks for it.
MadeEstimator make_estimator(const EffectDefinition& effect,
                             const std::shared_ptr<const Prediction>& prediction);

// Every effect that has a signature, in the order of the signal chain.
std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Prediction>& prediction,
                                           unsigned threads = 1);

}  // namespace gyrolog
