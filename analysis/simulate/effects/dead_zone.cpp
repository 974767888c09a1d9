#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_dead_zone(const EffectUse& use) {
    const double width_rad_s = use["width_dps"] * rad_per_deg;
    const double shift_rad_s = width_rad_s * (1.0 - use["jump"]);
    return make_rate_map(use, [=](double rate_rad_s) {
        if (std::fabs(rate_rad_s) <= width_rad_s) { return 0.0; }
        return rate_rad_s - std::copysign(shift_rad_s, rate_rad_s);
    });
}

constexpr EffectParam dead_zone_params[] = {
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

constexpr TrialValues with_offset[] = {{.param = "jump", .from = 0.0, .to = 0.0, .count = 1},
                                       {.param = "width_dps", .from = 0.003, .to = 0.6, .count = 11}};
constexpr TrialValues with_jump[] = {{.param = "jump", .from = 1.0, .to = 1.0, .count = 1},
                                     {.param = "width_dps", .from = 0.003, .to = 0.6, .count = 11}};
constexpr std::span<const TrialValues> dead_zone_trials[] = {with_offset, with_jump};

constexpr EffectSignature dead_zone_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .rates_up_to = "width_dps",
    .needs_reference = true,
    .trials = dead_zone_trials,
    .words = "Rates up to {width_dps} have no answer",
    .noun = "a dead zone of {width_dps}",
    .decided_by = "slow reversals through zero rate",
    .force_words = "Forces up to {width_dps} have no answer",
    .force_decided_by = "rests in which each axis is a little off level, to both sides",
};

}  // namespace

constinit const EffectDefinition dead_zone_effect = {
    .name = "dead_zone",
    .model = "0 for |w| <= width_dps, else w - (1 - jump) width_dps sign(w)",
    .source = "IEEE 528-2019 (dead band)",
    .params = dead_zone_params,
    .make = make_dead_zone,
    .signature = &dead_zone_signature,
};

}  // namespace gyrolog
