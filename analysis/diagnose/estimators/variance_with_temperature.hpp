// The variance with temperature is that of white noise whose level goes with the temperature. The likelihood
// is that of the whitened samples' variances by block (likelihood/variance_fit.hpp), with a standard
// deviation that is linear in the temperature.
//
// The effect's parameters are, in this order: relative change with each degree, temperature at which it is
// none. The latter is the model's own reference where the level there fits the model's N, else the
// recording's mean.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_variance_with_temperature_estimator(const EffectDefinition& effect,
                                                       std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
