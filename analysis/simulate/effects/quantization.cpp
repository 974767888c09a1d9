#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_quantization(const EffectUse& use) {
    const double lsb_rad_s = use["lsb_dps"] * rad_per_deg;
    return make_rate_map(use, [=](double rate_rad_s) {
        const double steps = std::floor(std::fabs(rate_rad_s) / lsb_rad_s + 0.5);
        return std::copysign(steps * lsb_rad_s, rate_rad_s);
    });
}

constexpr EffectParam quantization_params[] = {
    {.name = "lsb_dps",
     .meaning = "step",
     .range = EffectParam::Range::positive,
     .plausible_from = 1.0 / 65.5,
     .plausible_to = 8.0 / 65.5},
};

// Of rounding alone: white, where the noise spreads over more than a step.
void add_rounding(std::span<const double>, double rate_hz, const EffectValues& effect,
                  std::span<SpectralParts> parts) {
    const double lsb_rad_s = effect["lsb_dps"] * rad_per_deg;
    for (SpectralParts& part : parts) { part.other += lsb_rad_s * lsb_rad_s / (12.0 * rate_hz); }
}

constexpr EffectSignature quantization_signature = {
    .method = EvidenceMethod::quantisation_step,
    .place = PlaceKind::structure,
    .structure = "code_grid",
    .spectrum = add_rounding,
    .words = "The numbers come in steps of {lsb_dps}.",
    .noun = "a step of {lsb_dps}",
    .decided_by = "raw counts from the sensor's registers",
};

}  // namespace

constinit const EffectDefinition quantization_effect = {
    .name = "quantization",
    .model =
        "rate, rounded to a multiple of lsb_dps, half away from zero; the model's own step follows unless "
        "lsb_dps is coarser and no multiple of it",
    .source = "",
    .params = quantization_params,
    .make = make_quantization,
    .converter_step = "lsb_dps",
    .noise_only = true,
    .signature = &quantization_signature,
};

}  // namespace gyrolog
