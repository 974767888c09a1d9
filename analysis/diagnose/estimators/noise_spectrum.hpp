// The noise spectrum is what EffectSignature::spectrum makes of it. The estimator fits the effect's
// parameters by maximum of Whittle's likelihood of the binned cosine coefficients (likelihood/whittle.hpp),
// with the model's N, B and K refitted within their uncertainty. A mean response that changes with the
// spectrum (a low-pass filter's in a moving world) counts in the same likelihood.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_noise_spectrum_estimator(const EffectDefinition& effect,
                                            std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
