// Noise with heavier tails than the model's: Student's t in place of the normal distribution.
//
// The likelihood is that of the whitened samples, independent, with a free scale in both distributions: the
// level of the noise is no evidence. The effect's first parameter is the number of degrees of freedom.
#pragma once

#include "analysis/diagnose/estimators/effect_test.hpp"

namespace gyrolog {

MadeTest make_tail_test(const EffectDefinition& effect, std::shared_ptr<const Baseline> baseline);

}  // namespace gyrolog
