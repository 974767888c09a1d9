#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/temperature_bias.hpp"

namespace gyrolog {

namespace {

struct Cubic {
    double c1_rad_s_per_C;
    double c2_rad_s_per_C2;
    double c3_rad_s_per_C3;
    double reference_C;

    double operator()(double die_C) const {
        const double above_C = die_C - reference_C;
        return (c1_rad_s_per_C + (c2_rad_s_per_C2 + c3_rad_s_per_C3 * above_C) * above_C) * above_C;
    }
};

std::unique_ptr<Stage> make_temp_cubic(const EffectUse& use) {
    return std::make_unique<TemperatureBias<Cubic>>(
        use, Cubic{use["c1_dps_per_C"] * rad_per_deg, use["c2_dps_per_C2"] * rad_per_deg,
                   use["c3_dps_per_C3"] * rad_per_deg, reference_C(use)});
}

constexpr EffectParam temp_cubic_params[] = {
    {.name = "c1_dps_per_C",
     .meaning = "slope at the reference",
     .plausible_from = -0.3,
     .plausible_to = 0.3,
     .otherwise = 0.0},
    {.name = "c2_dps_per_C2",
     .meaning = "half of the curvature at the reference",
     .plausible_from = -0.02,
     .plausible_to = 0.02,
     .otherwise = 0.0},
    // 30 dps, the data sheet's, at 30 degC from the reference.
    {.name = "c3_dps_per_C3",
     .meaning = "coefficient of the third power",
     .plausible_from = -0.001,
     .plausible_to = 0.001},
    reference_C_param,
};

constexpr std::string_view temp_cubic_linear[] = {"c1_dps_per_C", "c2_dps_per_C2", "c3_dps_per_C3"};

constexpr EffectSignature temp_cubic_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .linear = temp_cubic_linear,
    .slow = true,
    .words =
        "The output follows the temperature along a cubic, {c1_dps_per_C}, {c2_dps_per_C2} and "
        "{c3_dps_per_C3}",
    .noun = "a cubic over the temperature",
    .decided_by = "one sweep of the temperature up and down by 20 degC or more",
};

}  // namespace

constinit const EffectDefinition temp_cubic_effect = {
    .name = "temp_cubic",
    .model =
        "rate + c1_dps_per_C (T - reference_C) + c2_dps_per_C2 (T - reference_C)^2 + c3_dps_per_C3 (T - "
        "reference_C)^3",
    .source = "",
    .params = temp_cubic_params,
    .make = make_temp_cubic,
    .signature = &temp_cubic_signature,
};

}  // namespace gyrolog
