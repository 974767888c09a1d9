#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_nonlinearity(const EffectUse& use) {
    const double full_scale_rad_s = use.context().model.full_scale_rad_s;
    const double per_full_scale = 1.0 / full_scale_rad_s;
    const double quadratic_rad_s = use["quadratic"] * full_scale_rad_s;
    const double cubic_rad_s = use["cubic"] * full_scale_rad_s;
    return make_rate_map(use, [=](double rate_rad_s) {
        const double x = rate_rad_s * per_full_scale;
        return rate_rad_s + x * x * (quadratic_rad_s + cubic_rad_s * x);
    });
}

constexpr EffectParam share_at_full_scale(std::string_view name, std::string_view meaning) {
    return {
        .name = name, .meaning = meaning, .plausible_from = -1e-3, .plausible_to = 1e-3, .otherwise = 0.0};
}

constexpr EffectParam nonlinearity_params[] = {
    share_at_full_scale("quadratic", "even error at full scale, as a fraction of it"),
    share_at_full_scale("cubic", "odd error at full scale, as a fraction of it"),
};

constexpr std::string_view nonlinearity_linear[] = {"quadratic", "cubic"};

constexpr EffectSignature nonlinearity_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .linear = nonlinearity_linear,
    .words = "The gain is not linear: {quadratic} even and {cubic} odd error at full scale",
    .noun = "an error of linearity",
    .decided_by = "plateaus of many rates of both signs up to full scale",
    .force_decided_by = "rests at many angles between each axis upward and downward",
};

}  // namespace

constinit const EffectDefinition nonlinearity_effect = {
    .name = "nonlinearity",
    .model = "w + FS (quadratic (w/FS)^2 + cubic (w/FS)^3), FS the model's full scale",
    .source = "IEEE 528-2019 (nonlinearity)",
    .params = nonlinearity_params,
    .make = make_nonlinearity,
    .signature = &nonlinearity_signature,
};

}  // namespace gyrolog
