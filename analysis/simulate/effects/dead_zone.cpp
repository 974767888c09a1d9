#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make(const EffectUse& use) {
    const double width_rad_s = use["width_dps"] * rad_per_deg;
    const double shift_rad_s = width_rad_s * (1.0 - use["jump"]);
    return make_rate_map(use, [=](double rate_rad_s) {
        if (std::fabs(rate_rad_s) <= width_rad_s) { return 0.0; }
        return rate_rad_s - std::copysign(shift_rad_s, rate_rad_s);
    });
}

constexpr EffectParam params[] = {
    {.name = "width_dps",
     .meaning = "rates up to this, of either sign, have no answer",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.003,
     .plausible_to = 0.5},
    {.name = "jump",
     .meaning = "0: beyond the zone the answer lacks the width; 1: it jumps to the full rate",
     .range = EffectParam::Range::share,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 0.0},
};

}  // namespace

constinit const EffectDefinition dead_zone_effect = {
    .name = "dead_zone",
    .model = "0 for |w| <= width_dps, else w - (1 - jump) width_dps sign(w)",
    .source = "IEEE 528-2019 (dead band)",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
