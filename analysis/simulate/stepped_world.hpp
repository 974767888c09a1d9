// A world that is told as time goes on, by a simulator's own steps.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/world.hpp"

namespace gyrolog {

struct WorldInstant {
    double t_s = 0.0;
    Vector3 rate_rad_s{};                                             // in the body's axes
    Vector3 specific_force_m_s2{};                                    // at rest with z upward: +g on z
    double temperature_C = std::numeric_limits<double>::quiet_NaN();  // NaN: not told

    bool tells_temperature() const { return !std::isnan(temperature_C); }
};

// Between two instants a straight line; before the first and after the last one the nearest. The last
// `kept` instants are remembered; add() allocates nothing.
class SteppedWorld final : public World {
public:
    explicit SteppedWorld(std::size_t kept) : ring_(kept) {}

    // `now.t_s` is later than the instant before. All instants tell the temperature, or none.
    void add(const WorldInstant& now);
    bool empty() const { return count_ == 0; }
    // Of the last instant; there is one.
    double now_s() const { return at(count_ - 1).t_s; }
    // False of a moment that is forgotten.
    bool remembers(double world_s) const { return forgotten_ == 0 || world_s >= at(0).t_s; }

    bool moves() const override { return true; }
    bool is_measured() const override { return false; }
    void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                const std::array<std::span<double>, 3>& specific_force_m_s2) const override;
    bool has_temperature() const override { return !empty() && at(0).tells_temperature(); }
    void temperature(std::span<const double> world_s, std::span<double> temperature_C) const override;

private:
    // Two instants that follow each other, and how far from one to the other; the same twice outside.
    struct Between {
        const WorldInstant* before;
        const WorldInstant* after;
        double share;
    };

    const WorldInstant& at(std::size_t place) const { return ring_[(first_ + place) % ring_.size()]; }
    Between between(double world_s) const;

    std::vector<WorldInstant> ring_;
    std::size_t first_ = 0;  // the oldest one
    std::size_t count_ = 0;
    std::size_t forgotten_ = 0;
};

}  // namespace gyrolog
