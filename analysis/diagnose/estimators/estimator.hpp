// An estimator finds what one effect can do for one observation.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// An estimator is made once for a prediction. After that it does not change, and any number of threads may
// ask it.
class Estimator {
public:
    virtual ~Estimator() = default;

    // The function returns the best that the effect can do for this observation beyond the prediction's
    // model; no value where the data have no trace of it (gain 0).
    virtual std::optional<Finding> find(const Observation& observation) const = 0;
};

// The estimator is null, with a reason, where the recording cannot show the effect: no temperature, no
// motion, too short.
struct MadeEstimator {
    std::unique_ptr<Estimator> estimator;
    std::string untestable;  // why not; a clause without a full stop
};
using EstimatorMaker = MadeEstimator (*)(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
