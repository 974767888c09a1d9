#include "analysis/simulate/stages/angle_quantisation.hpp"

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_angle_quantisation(const StageContext& context) {
    return PerAxis<AngleQuantisation>::make([&](std::size_t axis) -> std::optional<AngleQuantisation> {
        const double Q_rad = context.model.axes[axis].noise.Q_rad;
        if (Q_rad == 0.0) { return std::nullopt; }
        return AngleQuantisation{context.stream({'Q', '0'}, axis), Q_rad * context.rate_hz,
                                 context.stream({'Q', '0'}, axis, 1).normal(0)};
    });
}

}  // namespace gyrolog
