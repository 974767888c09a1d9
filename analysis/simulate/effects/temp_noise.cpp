#include <algorithm>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct OfTemperature {
    double per_C;
    double reference_C;

    double operator()(const SampleBlock& block, std::size_t i) const { return at(block.die_C[i]); }

    double at(double temperature_C) const {
        return std::max(white_gain_least, 1.0 + per_C * (temperature_C - reference_C));
    }
};

OfTemperature of_temperature(const EffectUse& use) { return {use["per_C"], reference_C(use)}; }

std::unique_ptr<Stage> make_temp_noise(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<OfTemperature>>(use, of_temperature(use));
}

WhiteGain temp_noise_white_gain(const EffectUse& use) {
    return [gain = of_temperature(use)](double, double temperature_C) { return gain.at(temperature_C); };
}

constexpr EffectParam temp_noise_params[] = {
    {.name = "per_C",
     .meaning = "relative change of the standard deviation with each degree",
     .plausible_from = -0.02,
     .plausible_to = 0.02},
    reference_C_param,
};

constexpr EffectSignature temp_noise_signature = {
    .method = EvidenceMethod::variance_with_temperature,
    .place = PlaceKind::temperature,
    .needs_temperature = true,
    .white_gain = temp_noise_white_gain,
    .words = "The white noise's standard deviation changes by {per_C} with each degree.",
    .noun = "a change of the white noise by {per_C} with each degree",
    .decided_by = "one sweep of the temperature up and down by 10 degC or more",
};

}  // namespace

constinit const EffectDefinition temp_noise_effect = {
    .name = "temp_noise",
    .model = "white noise times 1 + per_C (T - reference_C), at least 0.05",
    .source = "",
    .params = temp_noise_params,
    .make = make_temp_noise,
    .signature = &temp_noise_signature,
};

}  // namespace gyrolog
