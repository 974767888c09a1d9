#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_rate_ramp_effect(const StageContext& context, const EffectModel& effect) {
    SensorModel ramp_only;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (acts_on(effect, axis)) {
            ramp_only.axes[axis].noise.R_rad_per_s2 = effect.params.at("ramp_dps_per_s") * rad_per_deg;
        }
    }
    return make_rate_ramp({ramp_only, context.rate_hz, context.seed});
}

}  // namespace gyrolog
