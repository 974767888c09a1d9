// Outliers are single samples that are off, now and then.
//
// The likelihood is that of the whitened samples as a mixture: each is with a small probability off by a size
// uniform between two limits, of either sign, on top of its noise. Limits are tried in steps of a factor; the
// evidence is the average over them. Samples next to each other that are off alike are no single samples and
// left out.
//
// The effect's parameters are, in this order: number an hour, smallest size, largest size in deg/s.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_outlier_estimator(const EffectDefinition& effect,
                                     std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
