#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/flicker_noise.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_flicker_missing(const EffectUse& use) {
    return PerAxis<Flicker>::make([&](std::size_t axis) -> std::optional<Flicker> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return Flicker(use["B_dps"] * rad_per_deg, [&](unsigned part) { return use.stream(axis, part); });
    });
}

constexpr EffectParam flicker_missing_params[] = {
    {.name = "B_dps",
     .meaning = "bias instability, besides the model's own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0005,
     .plausible_to = 0.006},
};

void flicker_missing_spectrum(std::span<const double> f_hz, double /*rate_hz*/, const EffectValues& effect,
                              std::span<SpectralParts> parts) {
    const double B_rad_per_s = effect["B_dps"] * rad_per_deg;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i].flicker += B_rad_per_s * B_rad_per_s / (2.0 * pi * f_hz[i]);
    }
}

constexpr std::string_view flicker_missing_fitted[] = {"B_dps"};

constexpr EffectSignature flicker_missing_signature = {
    .spectral = flicker_missing_fitted,
    .slow_coefficient = 'B',
    .spectrum = flicker_missing_spectrum,
    .words = "Flicker noise is missing in the model, a bias instability of {B_dps}",
    .noun = "flicker noise of {B_dps}",
    .decided_by = "a still recording of {length} at a steady temperature",
};

}  // namespace

constinit const EffectDefinition flicker_missing_effect = {
    .name = "flicker_missing",
    .model = "noise of two-sided density B_dps^2 / (2 pi f), independent on each axis",
    .source = "IEEE 952-1997, annex C (bias instability); made as M. S. Keshner, Proc. IEEE 70 (1982) 212",
    .params = flicker_missing_params,
    .make = make_flicker_missing,
    .noise_only = true,
    .signature = &flicker_missing_signature,
};

}  // namespace gyrolog
