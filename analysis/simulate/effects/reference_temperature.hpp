// The temperature from which an effect counts.
#pragma once

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

inline constexpr EffectParam reference_C_param = {
    .name = "reference_C",
    .meaning = "where the effect is none; unless given, the model's reference temperature",
    .from_model = true,
    .plausible_from = 15.0,
    .plausible_to = 45.0};

inline double reference_C(const EffectUse& use) {
    const auto& temperature = use.context().model.temperature;
    return use.or_else("reference_C",
                       temperature ? temperature->reference_C : TemperatureModel{}.reference_C);
}

}  // namespace gyrolog
