// Tails are noise with heavier tails than the model's: Student's t in place of the normal distribution.
//
// The likelihood is that of the whitened samples, independent, with a free scale in both distributions: the
// level of the noise is no evidence. The effect's first parameter is the number of degrees of freedom.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_tail_estimator(const EffectDefinition& effect,
                                  std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
