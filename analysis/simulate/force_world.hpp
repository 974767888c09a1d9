// The specific force of a world as what acts on an accelerometer, which is simulated by the simulator of its
// gyro (resting_accelerometer.hpp): m/s^2 in the place of rad/s.
#pragma once

#include <memory>

#include "analysis/simulate/world.hpp"

namespace gyrolog {

class ForceWorld final : public World {
public:
    // `world` moves.
    explicit ForceWorld(std::shared_ptr<const World> world);

    bool moves() const override { return true; }
    bool is_measured() const override { return false; }
    void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                const std::array<std::span<double>, 3>& specific_force_m_s2) const override;
    bool has_temperature() const override { return world_->has_temperature(); }
    void temperature(std::span<const double> world_s, std::span<double> temperature_C) const override;
    const UpdateBeat* recorded_beat() const override { return world_->recorded_beat(); }

private:
    std::shared_ptr<const World> world_;
};

}  // namespace gyrolog
