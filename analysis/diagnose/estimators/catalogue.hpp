// The estimators by the method that an effect's signature names, one line each.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/diagnose/estimators/effect_test.hpp"

namespace gyrolog {

struct CatalogueEntry {
    const EffectDefinition* effect = nullptr;
    std::unique_ptr<EffectTest> test;
    std::string untestable;  // why there is no test
};

// By which an effect is looked for: in a moving world the mean answer tells far more than the noise does.
EvidenceMethod evidence_method(const EffectSignature& signature, const Baseline& baseline);

// Of one effect; without a test and a reason where nothing looks for it.
MadeTest make_test(const EffectDefinition& effect, const std::shared_ptr<const Baseline>& baseline);

// Every effect that has a signature, in the order of the signal chain.
std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Baseline>& baseline,
                                           unsigned threads = 1);

}  // namespace gyrolog
