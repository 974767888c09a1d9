// Effects that change the spectrum of the noise (EffectSignature::spectrum): their parameters by maximum of
// the Whittle likelihood of the binned cosine coefficients (noise_nuisance.hpp), with the model's N, B and K
// refitted within their uncertainty. A mean response that changes with it (a low-pass filter's in a moving
// world) counts in the same likelihood.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_noise_spectrum_estimator(const EffectDefinition& effect,
                                            std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
