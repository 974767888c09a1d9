#include "analysis/simulate/stages/rate_ramp.hpp"

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_rate_ramp(const StageContext& context) {
    return PerAxis<RateRamp>::make([&](std::size_t axis) -> std::optional<RateRamp> {
        const double R = context.model.axes[axis].noise.R_rad_per_s2;
        if (R == 0.0) { return std::nullopt; }
        return RateRamp{R / context.rate_hz};
    });
}

}  // namespace gyrolog
