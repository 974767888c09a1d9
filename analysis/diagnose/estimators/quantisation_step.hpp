// The quantisation step is the converter's, read from the numbers themselves. Where the model has a step, the
// changes from sample to sample are whole multiples of it; noise that reaches over several codes makes one in
// m of them a multiple of m. With a share p of n changes that are, the gain is, in nats,
//   n (p ln(p m) + (1 - p) ln((1 - p) / (1 - 1/m))).
// Where the model has none, a number falls within a twentieth of a step of a grid's place by chance with
// probability 1/10: each change gains ln 10. A step finer than the model's cannot be added to it and is no
// finding.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_quantisation_step_estimator(const EffectDefinition& effect,
                                               std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
