#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/angle_quantisation.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_angle_noise(const EffectUse& use) {
    const double scale_rad_s = use["Q_dps_s"] * rad_per_deg * use.context().rate_hz;
    return PerAxis<AngleQuantisation>::make([&](std::size_t axis) -> std::optional<AngleQuantisation> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return AngleQuantisation{use.stream(axis), scale_rad_s, use.stream(axis, 1).normal(0)};
    });
}

constexpr EffectParam angle_noise_params[] = {
    {.name = "Q_dps_s",
     .meaning = "quantisation noise of the angle, besides the model's own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0,
     .plausible_to = 1e-3},
};

}  // namespace

constinit const EffectDefinition angle_noise_effect = {
    .name = "angle_noise",
    .model =
        "rate of an angle with independent errors of standard deviation Q_dps_s, independent on each axis",
    .source = "IEEE 952-1997, annex C (quantization noise)",
    .params = angle_noise_params,
    .make = make_angle_noise,
    .noise_only = true,
};

}  // namespace gyrolog
