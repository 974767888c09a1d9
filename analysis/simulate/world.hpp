// What is done to a simulated sensor: motion and temperature over time. Any number of simulations, on any
// threads, may share one.
#pragma once

#include <array>
#include <span>

namespace gyrolog {

class UpdateBeat;

class World {
public:
    virtual ~World() = default;

    // False: at rest for ever, its z axis upward; motion() is then never asked.
    virtual bool moves() const = 0;
    // True: the rates come from a reference instrument, and its noise (SensorModel::ref_noise_rad_s) is in
    // them.
    virtual bool is_measured() const = 0;
    // At moments that ascend but for jitter, in the body's axes. All spans are of one size.
    virtual void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                        const std::array<std::span<double>, 3>& specific_force_m_s2) const = 0;

    // False: the temperature is the simulator's to make up.
    virtual bool has_temperature() const = 0;
    virtual void temperature(std::span<const double> world_s, std::span<double> temperature_C) const = 0;

    // The beat in which the sensor repeated itself that was there; null: the simulator's to draw.
    virtual const UpdateBeat* recorded_beat() const { return nullptr; }
};

}  // namespace gyrolog
