// The range in which a parameter of a noise spectrum is fitted.
#pragma once

#include "analysis/simulate/effect.hpp"
#include "analysis/simulate/effect_signature.hpp"

namespace gyrolog {

struct SpectralRange {
    double least = 0.0;
    double most = 0.0;
};

// `param` is one of the signature's `spectral` parameters, in whose unit the range is. A parameter of the
// shape is within its plausible range or little beyond (DecisionOptions::beyond_plausible); a size may be far
// smaller than one that people meet. A filter whose corner lies beyond half of `rate_hz` is not seen as one:
// what folds back makes the noise stronger, and hardly less white.
SpectralRange spectral_range(const EffectSignature& signature, const EffectParam& param, double rate_hz);

}  // namespace gyrolog
