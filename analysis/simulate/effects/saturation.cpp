#include <algorithm>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make(const EffectUse& use) {
    const double limit_rad_s = use["limit_dps"] * rad_per_deg;
    return make_rate_map(
        use, [=](double rate_rad_s) { return std::clamp(rate_rad_s, -limit_rad_s, limit_rad_s); });
}

constexpr EffectParam params[] = {
    {.name = "limit_dps",
     .meaning = "largest rate of either sign",
     .range = EffectParam::Range::positive,
     .plausible_from = 245.0,
     .plausible_to = 450.0},
};

constexpr TrialValues limit_values[] = {
    {.param = "limit_dps", .from = 235.0, .to = 495.0, .count = 27, .even = true}};
constexpr std::span<const TrialValues> trials[] = {limit_values};

constexpr EffectSignature signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .trials = trials,
    .words = "The output is clipped at {limit_dps}",
    .decided_by = "plateaus of both signs up to full scale",
};

}  // namespace

constinit const EffectDefinition saturation_effect = {
    .name = "saturation",
    .model = "rate, clipped at +-limit_dps, noise and bias included",
    .source = "",
    .params = params,
    .make = make,
    .signature = &signature,
};

}  // namespace gyrolog
