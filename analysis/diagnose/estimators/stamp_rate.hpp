// The stamp rate is the mean rate of the time stamps against the model's. With the relative difference d and
// its standard deviation s, from the model's stated rate_rel and the stamps' own, a free rate gains d^2 / (2
// s^2), in nats.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_stamp_rate_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
