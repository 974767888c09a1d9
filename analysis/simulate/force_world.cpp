#include "analysis/simulate/force_world.hpp"

#include <algorithm>
#include <utility>

namespace gyrolog {

ForceWorld::ForceWorld(std::shared_ptr<const World> world) : world_(std::move(world)) {}

void ForceWorld::motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                        const std::array<std::span<double>, 3>& specific_force_m_s2) const {
    world_->motion(world_s, rate_rad_s, specific_force_m_s2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::ranges::copy(specific_force_m_s2.at(axis), rate_rad_s.at(axis).begin());
    }
}

void ForceWorld::temperature(std::span<const double> world_s, std::span<double> temperature_C) const {
    world_->temperature(world_s, temperature_C);
}

}  // namespace gyrolog
