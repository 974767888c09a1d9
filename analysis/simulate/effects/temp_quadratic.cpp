#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/temperature_bias.hpp"

namespace gyrolog {

namespace {

struct Parabola {
    double c1_rad_s_per_C;
    double c2_rad_s_per_C2;
    double reference_C;

    double operator()(double die_C) const {
        const double above_C = die_C - reference_C;
        return (c1_rad_s_per_C + c2_rad_s_per_C2 * above_C) * above_C;
    }
};

std::unique_ptr<Stage> make_temp_quadratic(const EffectUse& use) {
    return std::make_unique<TemperatureBias<Parabola>>(
        use,
        Parabola{use["c1_dps_per_C"] * rad_per_deg, use["c2_dps_per_C2"] * rad_per_deg, reference_C(use)});
}

constexpr EffectParam temp_quadratic_params[] = {
    {.name = "c1_dps_per_C",
     .meaning = "slope at the reference",
     .plausible_from = -0.3,
     .plausible_to = 0.3,
     .otherwise = 0.0},
    {.name = "c2_dps_per_C2",
     .meaning = "half of the curvature",
     .plausible_from = -0.02,
     .plausible_to = 0.02},
    reference_C_param,
};

constexpr std::string_view temp_quadratic_linear[] = {"c1_dps_per_C", "c2_dps_per_C2"};

constexpr EffectSignature temp_quadratic_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .linear = temp_quadratic_linear,
    .slow = true,
    .words = "The output follows the temperature along a parabola, {c1_dps_per_C} and {c2_dps_per_C2}",
    .noun = "a parabola over the temperature",
    .decided_by = "one sweep of the temperature up and down by 10 degC or more",
};

}  // namespace

constinit const EffectDefinition temp_quadratic_effect = {
    .name = "temp_quadratic",
    .model = "rate + c1_dps_per_C (T - reference_C) + c2_dps_per_C2 (T - reference_C)^2",
    .source = "",
    .params = temp_quadratic_params,
    .make = make_temp_quadratic,
    .signature = &temp_quadratic_signature,
};

}  // namespace gyrolog
