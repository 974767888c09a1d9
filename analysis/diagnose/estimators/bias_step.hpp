// The bias step is one jump of the bias at one moment, with a height of each axis' own. The effect's
// parameters are step_dps and at_s.
//
// A jump before sample m has the cosine coefficients
//   g_k(m) = -sqrt(2/n) sin(pi k m/n) / (2 sin(pi k/2n))                     (a geometric series)
// Least squares of it against the expected density, for all m at once, are two transforms of the lowest
// coefficients: what a jump has to show against noise that wanders lies there. N, B and K are fitted to what
// the jump leaves, and the scan is made again with them: a jump looks like random walk. Where the jump is
// seen within a few seconds, the samples themselves tell its moment.
//
// The evidence pays for each height, and for the moment: uniform over the record, what is left of that by the
// likelihood.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_bias_step_estimator(const EffectDefinition& effect,
                                       std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
