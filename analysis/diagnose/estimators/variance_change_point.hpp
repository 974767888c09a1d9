// The variance change point is where the level of the white noise changes: once, in a step or along a
// straight line.
//
// The likelihood is that of the whitened samples' variances by block (likelihood/variance_fit.hpp); where the
// samples have tails beside, that of Student's t. Steps at every block and ramps between coarser times are as
// likely in all; the evidence is their average. Axes that change share the times; the factors are their own.
// Where the level before the change is the model's and the mean level is not, that counts too.
//
// The effect's parameters are, in this order: factor, start, duration.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_variance_change_point_estimator(const EffectDefinition& effect,
                                                   std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
