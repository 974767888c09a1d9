// The mean rate of the time stamps against the model's. With the relative difference d and its standard
// deviation s, from the model's stated rate_rel and the stamps' own, a free rate gains d^2 / (2 s^2).
#pragma once

#include "analysis/diagnose/estimators/effect_test.hpp"

namespace gyrolog {

MadeTest make_stamp_rate_test(const EffectDefinition& effect, std::shared_ptr<const Baseline> baseline);

}  // namespace gyrolog
