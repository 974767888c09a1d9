// Sampling jitter is sampling instants that scatter while the stamps are regular. In a moving world each
// sample is then off by the rate's change times its own error, so that whitened samples have the variance
//   c (1 + q d^2),   q = sd^2 / (variance of the white noise),   d the change of the model's answer, rad/s^2
// with one sd, in s, for all axes and a level c by axis, free within what the model says of N.
#pragma once

#include <memory>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// The function returns null for a recording without motion.
std::unique_ptr<Estimator> make_sampling_jitter_estimator(const EffectDefinition& effect,
                                                          std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
