#include <algorithm>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct OfTemperature {
    double per_C;
    double reference_C;

    double operator()(const SampleBlock& block, std::size_t i) const {
        // However far the temperature goes, some noise is left.
        return std::max(0.05, 1.0 + per_C * (block.die_C[i] - reference_C));
    }
};

std::unique_ptr<Stage> make(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<OfTemperature>>(use,
                                                           OfTemperature{use["per_C"], reference_C(use)});
}

constexpr EffectParam params[] = {
    {.name = "per_C",
     .meaning = "relative change of the standard deviation with each degree",
     .plausible_from = -0.02,
     .plausible_to = 0.02},
    reference_C_param,
};

}  // namespace

constinit const EffectDefinition temp_noise_effect = {
    .name = "temp_noise",
    .model = "white noise times 1 + per_C (T - reference_C), at least 0.05",
    .source = "",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
