#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct Factor {
    double factor;

    double operator()(const SampleBlock& /*block*/, std::size_t /*i*/) const { return factor; }
};

std::unique_ptr<Stage> make(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<Factor>>(use, Factor{use["factor"]});
}

constexpr EffectParam params[] = {
    {.name = "factor",
     .meaning = "of the angle random walk N",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.5,
     .plausible_to = 2.0},
};

}  // namespace

constinit const EffectDefinition arw_scale_effect = {
    .name = "arw_scale",
    .model = "white noise times factor",
    .source = "",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
