#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/reference_temperature.hpp"
#include "analysis/simulate/stages/temperature_scale.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_temp_scale(const EffectUse& use) {
    Vector3 per_C{};
    for (std::size_t axis = 0; axis < 3; ++axis) { per_C[axis] = use.acts_on(axis) ? use["per_C"] : 0.0; }
    return std::make_unique<TemperatureScale>(per_C, reference_C(use));
}

constexpr EffectParam temp_scale_params[] = {
    {.name = "per_C",
     .meaning = "relative change of the scale factor for each degree Celsius",
     .plausible_from = -1e-3,
     .plausible_to = 1e-3},
    reference_C_param,
};

}  // namespace

constinit const EffectDefinition temp_scale_effect = {
    .name = "temp_scale",
    .model = "rate (1 + per_C (T - reference_C)), bias and noise included",
    .source = "MathWorks imuSensor (scale factor error)",
    .params = temp_scale_params,
    .make = make_temp_scale,
};

}  // namespace gyrolog
