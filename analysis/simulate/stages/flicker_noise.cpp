#include "analysis/simulate/stages/flicker_noise.hpp"

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

std::unique_ptr<Stage> make_flicker_noise(const StageContext& context) {
    return PerAxis<Flicker>::make([&](std::size_t axis) -> std::optional<Flicker> {
        const double B_rad_per_s = context.model.axes[axis].noise.B_rad_per_s;
        if (B_rad_per_s == 0.0) { return std::nullopt; }
        return Flicker(B_rad_per_s, [&](unsigned part) { return context.stream({'B', '0'}, axis, part); });
    });
}

}  // namespace gyrolog
