// Repeats are samples that are the ones before again, in all axes at once, and in the temperature where its
// numbers move (likelihood/repeat_patterns.hpp). Rounded noise repeats by chance, but in each axis by itself;
// samples two apart tell how often axes do so together for other reasons. Where a single axis has to do, the
// chance of its repeats is read from how often its steps are one and two codes: their distribution is smooth.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_repeat_estimator(const EffectDefinition& effect,
                                    std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
