// The mean response is the sensor's noise-free answer to the world: its temperature, its time, its motion.
// The estimator finds effects that change it.
//
// The cosine coefficients of the residual are independent and normal with the mean sum_j c_j G_jk and the
// variance S_k rate, with G_j what the simulator answers to one unit of parameter j without noise:
// generalised least squares (likelihood/mean_regression.hpp). Other parameters are found by trial and
// parabola. N, B and K are refitted to what is left, and the model's own uncertain gains, latency and clock
// (Prediction::uncertain) beside.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_mean_response_estimator(const EffectDefinition& effect,
                                           std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
