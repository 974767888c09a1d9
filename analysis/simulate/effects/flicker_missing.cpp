#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/flicker_noise.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make(const EffectUse& use) {
    return PerAxis<Flicker>::make([&](std::size_t axis) -> std::optional<Flicker> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return Flicker(use["B_dps"] * rad_per_deg, [&](unsigned part) { return use.stream(axis, part); });
    });
}

constexpr EffectParam params[] = {
    {.name = "B_dps",
     .meaning = "bias instability, besides the model's own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0005,
     .plausible_to = 0.006},
};

}  // namespace

constinit const EffectDefinition flicker_missing_effect = {
    .name = "flicker_missing",
    .model = "noise of two-sided density B_dps^2 / (2 pi f), independent on each axis",
    .source = "IEEE 952-1997, annex C (bias instability); made as M. S. Keshner, Proc. IEEE 70 (1982) 212",
    .params = params,
    .make = make,
    .noise_only = true,
};

}  // namespace gyrolog
