// Random telegraph noise is a bias that jumps to and fro between two levels. The effect's parameters are
// amplitude_dps, dwell_high_s and dwell_low_s.
//
// Its spectrum is that of Gauss-Markov noise, so what sets a telegraph apart is how its values are
// distributed. Its likelihood is taken as
//   Whittle's, of the spectrum (likelihood/noise_nuisance.hpp)
//   * that of two levels / that of Gauss-Markov noise of the same variance and correlation time,
// the quotient from averages of the samples in one description of the other noise (telegraph_filter.hpp). So
// its gain can be set against that of any spectral effect.
//
// The estimator asks this only where the spectrum, N, B and K refitted, shows an excess of the telegraph's
// form.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_random_telegraph_estimator(const EffectDefinition& effect,
                                              std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
