// Stamp jitter is the scatter of the time stamps against the model's. The log-likelihood of an estimated
// sigma s, as good as n independent errors make it, is -n (ln sigma + s^2 / (2 sigma^2)). The model's sigma
// is free within its stated uncertainty, and the stamps' rounding adds to it.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_stamp_jitter_estimator(const EffectDefinition& effect,
                                          std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
