#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_scale_factor(const EffectUse& use) {
    const double gain = 1.0 + use["eps"];
    return make_rate_map(use, [gain](double rate_rad_s) { return gain * rate_rad_s; });
}

constexpr EffectParam scale_factor_params[] = {
    {.name = "eps", .meaning = "relative gain error", .plausible_from = -0.03, .plausible_to = 0.03},
};

constexpr std::string_view scale_factor_linear[] = {"eps"};

constexpr EffectSignature scale_factor_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .linear = scale_factor_linear,
    .words = "The scale factor is off by {eps}",
    .noun = "a scale factor error of {eps}",
    .decided_by = "plateaus of several rates of both signs about one axis after the other",
    .force_decided_by = "rests with each axis upward, downward and at several angles between",
};

}  // namespace

constinit const EffectDefinition scale_factor_effect = {
    .name = "scale_factor",
    .model = "(1 + eps) w, w the answer to the motion before bias and noise",
    .source = "IEEE 528-2019 (scale factor error)",
    .params = scale_factor_params,
    .make = make_scale_factor,
    .signature = &scale_factor_signature,
};

}  // namespace gyrolog
