#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/rate_random_walk.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_rrw_missing(const EffectUse& use) {
    const double step_sd_rad_s = use["K_dps_sqrt_hz"] * rad_per_deg / std::sqrt(use.context().rate_hz);
    return PerAxis<RateRandomWalk>::make([&](std::size_t axis) -> std::optional<RateRandomWalk> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return RateRandomWalk{use.stream(axis), step_sd_rad_s};
    });
}

constexpr EffectParam rrw_missing_params[] = {
    {.name = "K_dps_sqrt_hz",
     .meaning = "rate random walk, besides the model's own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 3e-5,
     .plausible_to = 2e-3},
};

void rrw_missing_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                          std::span<SpectralParts> parts) {
    const double K_rad_per_s_sqrt_s = effect["K_dps_sqrt_hz"] * rad_per_deg;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double sampled_omega = 2.0 * rate_hz * std::sin(pi * f_hz[i] / rate_hz);
        parts[i].walk += K_rad_per_s_sqrt_s * K_rad_per_s_sqrt_s / (sampled_omega * sampled_omega);
    }
}

constexpr std::string_view rrw_missing_fitted[] = {"K_dps_sqrt_hz"};

constexpr EffectSignature rrw_missing_signature = {
    .spectral = rrw_missing_fitted,
    .slow_coefficient = 'K',
    .spectrum = rrw_missing_spectrum,
    .words = "The output wanders: a rate random walk of {K_dps_sqrt_hz} is missing in the model",
    .noun = "a rate random walk of {K_dps_sqrt_hz}",
    .decided_by = "a still recording of {length} at a steady temperature",
    .force_words =
        "The output wanders: an acceleration random walk of {K_dps_sqrt_hz} is missing in the "
        "model",
    .force_noun = "an acceleration random walk of {K_dps_sqrt_hz}",
};

}  // namespace

constinit const EffectDefinition rrw_missing_effect = {
    .name = "rrw_missing",
    .model = "random walk from zero, variance K_dps_sqrt_hz^2 t, independent on each axis",
    .source = "IEEE 952-1997, annex C (rate random walk)",
    .params = rrw_missing_params,
    .make = make_rrw_missing,
    .noise_only = true,
    .signature = &rrw_missing_signature,
};

}  // namespace gyrolog
