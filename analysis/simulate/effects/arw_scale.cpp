#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct Factor {
    double factor;

    double operator()(const SampleBlock& /*block*/, std::size_t /*i*/) const { return factor; }
};

std::unique_ptr<Stage> make_arw_scale(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<Factor>>(use, Factor{use["factor"]});
}

constexpr EffectParam arw_scale_params[] = {
    {.name = "factor",
     .meaning = "of the angle random walk N",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.5,
     .plausible_to = 2.0},
};

void arw_scale_spectrum(std::span<const double> /*f_hz*/, double /*rate_hz*/, const EffectValues& effect,
                        std::span<SpectralParts> parts) {
    for (SpectralParts& part : parts) { part.white *= effect["factor"] * effect["factor"]; }
}

constexpr std::string_view arw_scale_fitted[] = {"factor"};

constexpr EffectSignature arw_scale_signature = {
    .spectral = arw_scale_fitted,
    .spectrum = arw_scale_spectrum,
    .words = "The white noise is {factor} times the model's",
    .noun = "white noise",
    .decided_by = "any still recording of some minutes at another sample rate",
};

}  // namespace

constinit const EffectDefinition arw_scale_effect = {
    .name = "arw_scale",
    .model = "white noise times factor",
    .source = "",
    .params = arw_scale_params,
    .make = make_arw_scale,
    .signature = &arw_scale_signature,
};

}  // namespace gyrolog
