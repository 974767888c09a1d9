// Shared noise is white noise that the axes have in common. It shows in the covariance of their cosine
// coefficients where white noise rules.
//
// Coefficients X_a, scaled by the expected density, have the covariance
//   E X_a X_b = h_a h_b,  a != b;    E X_a^2 = w_a level_a^2 + (1 - w_a) + h_a^2
// with h_a the shared noise and w_a the share of the axis' own white noise, whose level the model knows as
// well as its N. The gain is what the correlation gains and what the raised level does.
//
// The effect's parameters are, in this order: density, then the gains of the three axes.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_shared_noise_estimator(const EffectDefinition& effect,
                                          std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
