// Saturation is a largest rate that the output does not pass. Where the clipping comes after the noise,
// samples pile up on one code m: with r = m - expected, in units of the noise's sigma, a pile gains, in nats,
//   sum over it of ln (Q(r) sigma / (phi(r) lsb)),
// Q the normal distribution's upper tail, phi its density. Where the clipping comes before, the mean answer
// shows it (mean_response.hpp). The estimator finds the better of both.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_saturation_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
