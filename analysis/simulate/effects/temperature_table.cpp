#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/temperature_bias.hpp"

namespace gyrolog {

namespace {

struct BiasByTemperature {
    Course bias_dps;

    double operator()(double die_C) const { return bias_dps(die_C) * rad_per_deg; }
};

std::unique_ptr<Stage> make_temperature_table(const EffectUse& use) {
    return std::make_unique<TemperatureBias<BiasByTemperature>>(use, BiasByTemperature{use.course()});
}

constexpr EffectSignature temperature_table_signature = {
    .method = EvidenceMethod::temperature_table,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .words = "The output follows the temperature along a course of its own.",
    .noun = "a course over the temperature",
};

}  // namespace

constinit const EffectDefinition temperature_table_effect = {
    .name = "temperature_table",
    .model = "rate + bias_dps(T), straight between the table's points",
    .source = "",
    .params = {},
    .make = make_temperature_table,
    .table = EffectTable{.at = "temp_C",
                         .value = "bias_dps",
                         .meaning = "added to the bias, by temperature; beyond the table as at its ends"},
    .form = "temperature",
    .signature = &temperature_table_signature,
};

}  // namespace gyrolog
