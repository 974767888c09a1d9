#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/temperature_bias.hpp"

namespace gyrolog {

namespace {

struct Line {
    double slope_rad_s_per_C;
    double reference_C;

    double operator()(double die_C) const { return slope_rad_s_per_C * (die_C - reference_C); }
};

std::unique_ptr<Stage> make_temp_linear(const EffectUse& use) {
    return std::make_unique<TemperatureBias<Line>>(use,
                                                   Line{use["c1_dps_per_C"] * rad_per_deg, reference_C(use)});
}

constexpr EffectParam temp_linear_params[] = {
    {.name = "c1_dps_per_C", .meaning = "slope", .plausible_from = -0.3, .plausible_to = 0.3},
    reference_C_param,
};

constexpr std::string_view temp_linear_linear[] = {"c1_dps_per_C"};

constexpr EffectSignature temp_linear_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .linear = temp_linear_linear,
    .slow = true,
    .words = "The output follows the temperature, {c1_dps_per_C}",
    .noun = "a temperature coefficient of {c1_dps_per_C}",
    .decided_by = "one sweep of the temperature up and down by 5 degC or more",
};

}  // namespace

constinit const EffectDefinition temp_linear_effect = {
    .name = "temp_linear",
    .model = "rate + c1_dps_per_C (T - reference_C)",
    .source = "",
    .params = temp_linear_params,
    .make = make_temp_linear,
    .signature = &temp_linear_signature,
};

}  // namespace gyrolog
