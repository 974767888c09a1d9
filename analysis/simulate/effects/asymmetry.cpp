#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_asymmetry(const EffectUse& use) {
    const double gain = use["gain"];
    return make_rate_map(use,
                         [gain](double rate_rad_s) { return rate_rad_s + gain * std::fabs(rate_rad_s); });
}

constexpr EffectParam asymmetry_params[] = {
    {.name = "gain",
     .meaning = "half the difference of the gains of the two directions",
     .plausible_from = -0.01,
     .plausible_to = 0.01},
};

constexpr std::string_view asymmetry_linear[] = {"gain"};

constexpr EffectSignature asymmetry_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .linear = asymmetry_linear,
    .words = "The two directions have different gains, by {gain} either way",
    .noun = "a gain that differs with the direction by {gain}",
    .decided_by = "the same plateaus in both directions, and slow reversals",
    .force_decided_by = "rests at many angles between each axis upward and downward",
};

}  // namespace

constinit const EffectDefinition asymmetry_effect = {
    .name = "asymmetry",
    .model = "w + gain |w|",
    .source = "IEEE 528-2019 (scale factor asymmetry)",
    .params = asymmetry_params,
    .make = make_asymmetry,
    .signature = &asymmetry_signature,
};

}  // namespace gyrolog
