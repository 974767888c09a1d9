#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/rate_random_walk.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make(const EffectUse& use) {
    const double step_sd_rad_s = use["K_dps_sqrt_hz"] * rad_per_deg / std::sqrt(use.context().rate_hz);
    return PerAxis<RateRandomWalk>::make([&](std::size_t axis) -> std::optional<RateRandomWalk> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return RateRandomWalk{use.stream(axis), step_sd_rad_s};
    });
}

constexpr EffectParam params[] = {
    {.name = "K_dps_sqrt_hz",
     .meaning = "rate random walk, besides the model's own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 3e-5,
     .plausible_to = 2e-3},
};

}  // namespace

constinit const EffectDefinition rrw_missing_effect = {
    .name = "rrw_missing",
    .model = "random walk from zero, variance K_dps_sqrt_hz^2 t, independent on each axis",
    .source = "IEEE 952-1997, annex C (rate random walk)",
    .params = params,
    .make = make,
    .noise_only = true,
};

}  // namespace gyrolog
