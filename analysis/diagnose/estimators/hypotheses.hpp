// Hypotheses are what every estimator of the catalogue says of one recording under one model.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

struct Hypotheses {
    std::shared_ptr<const Prediction> prediction;
    std::shared_ptr<const Observation> observation;
    std::vector<CatalogueEntry> catalogue;
    std::vector<std::optional<Finding>> findings;  // by entry of the catalogue

    // The finding with the most evidence; null where there is none.
    const Finding* best() const;
};

// The function asks every estimator. `seed` draws what stands in the recording's holes.
Hypotheses examine(const std::shared_ptr<const Prediction>& prediction,
                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed, unsigned threads);

// The same of what is observed under the prediction already.
Hypotheses examine(const std::shared_ptr<const Prediction>& prediction,
                   std::shared_ptr<const Observation> observation, unsigned threads);

// The function asks the estimator of one effect, which the recording of `completed` can show. Holes are
// filled as there. No value where the data have no trace of the effect.
std::optional<Finding> examine_for(std::string_view effect,
                                   const std::shared_ptr<const Prediction>& prediction,
                                   const Observation& completed);

}  // namespace gyrolog
