#include "analysis/simulate/stages/rate_ramp.hpp"

#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_rate_ramp(const EffectUse& use) {
    return PerAxis<RateRamp>::make([&](std::size_t axis) -> std::optional<RateRamp> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return RateRamp{use["ramp_dps_per_s"] * rad_per_deg / use.context().rate_hz};
    });
}

constexpr EffectParam rate_ramp_params[] = {
    {.name = "ramp_dps_per_s", .meaning = "slope", .plausible_from = -2e-4, .plausible_to = 2e-4},
};

constexpr std::string_view rate_ramp_linear[] = {"ramp_dps_per_s"};

constexpr EffectSignature rate_ramp_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::time,
    .linear = rate_ramp_linear,
    .slow = true,
    .words = "The output drifts in proportion to time, by {ramp_dps_per_s}",
    .noun = "a drift of {ramp_dps_per_s}",
    .decided_by = "a second recording right after this one: a ramp goes on, a random walk does not",
};

}  // namespace

constinit const EffectDefinition rate_ramp_effect = {
    .name = "rate_ramp",
    .model = "rate + ramp_dps_per_s t",
    .source = "IEEE 952-1997, C.1 (rate ramp)",
    .params = rate_ramp_params,
    .make = make_rate_ramp,
    .signature = &rate_ramp_signature,
};

}  // namespace gyrolog
