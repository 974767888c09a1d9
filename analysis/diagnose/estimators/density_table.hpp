// The density estimator finds the shape of the white noise's density without a formula: by axis, an
// autoregression's.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// The autoregression's covariances are fitted by expectation and maximisation (Dempster, Laird, Rubin,
// J. R. Stat. Soc. B 39 (1977) 1): the expected power of the white noise in each bin, given the power that is
// seen and the other noise of the model; then Levinson's recursion. The order is that of the most evidence by
// Schwarz's approximation (Ann. Stat. 6 (1978) 461). The entries hold no more of the shape than the bins
// tell.
MadeEstimator make_density_table_estimator(const EffectDefinition& effect,
                                           std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
