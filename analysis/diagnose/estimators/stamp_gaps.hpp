// Stamp gaps are lost samples that the time stamps tell of: bursts that come as a Poisson process in the
// delivered slots. With n bursts in T of delivered time the rate is n / T; against a model that expects
// lambda the gain is, in nats,
//   n ln(n / (lambda T)) - (n - lambda T)
// and, where the model has the effect already, what its greatest length forbids. A model without it expects
// so few that every gap counts as almost certain.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_stamp_gap_estimator(const EffectDefinition& effect,
                                       std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
