#include "analysis/simulate/stages/temperature_scale.hpp"

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_temperature_scale(const StageContext& context) {
    const auto& temperature = context.model.temperature;
    if (!temperature || temperature->scale_per_C == Vector3{}) { return nullptr; }
    return std::make_unique<TemperatureScale>(temperature->scale_per_C, temperature->reference_C);
}

}  // namespace gyrolog
