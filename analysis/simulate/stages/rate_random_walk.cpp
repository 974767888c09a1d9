#include "analysis/simulate/stages/rate_random_walk.hpp"

#include <cmath>

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_rate_random_walk(const StageContext& context) {
    return PerAxis<RateRandomWalk>::make([&](std::size_t axis) -> std::optional<RateRandomWalk> {
        const double K = context.model.axes[axis].noise.K_rad_per_s_sqrt_s;
        if (K == 0.0) { return std::nullopt; }
        return RateRandomWalk{context.stream({'K', '0'}, axis), K / std::sqrt(context.rate_hz)};
    });
}

}  // namespace gyrolog
