#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_rate_table(const EffectUse& use) {
    return make_rate_map(use, [added_dps = use.course()](double rate_rad_s) {
        return rate_rad_s + added_dps(rate_rad_s * deg_per_rad) * rad_per_deg;
    });
}

constexpr EffectSignature rate_table_signature = {
    .method = EvidenceMethod::rate_table,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .words = "The output strays from the rate along a course of its own.",
    .noun = "a course over the rate",
};

}  // namespace

constinit const EffectDefinition rate_table_effect = {
    .name = "rate_table",
    .model = "w + added_dps(w), straight between the table's points",
    .source = "",
    .params = {},
    .make = make_rate_table,
    .table = EffectTable{.at = "rate_dps",
                         .value = "added_dps",
                         .meaning = "added to the rate, by rate; beyond the table as at its ends"},
    .form = "rate",
    .signature = &rate_table_signature,
};

}  // namespace gyrolog
