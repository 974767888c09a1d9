#include "analysis/simulate/stepped_world.hpp"

namespace gyrolog {

void SteppedWorld::add(const WorldInstant& now) {
    if (count_ == ring_.size()) {
        first_ = (first_ + 1) % ring_.size();
        --count_;
        ++forgotten_;
    }
    ring_[(first_ + count_) % ring_.size()] = now;
    ++count_;
}

SteppedWorld::Between SteppedWorld::between(double world_s) const {
    std::size_t low = 0;  // at or before the moment
    std::size_t high = count_ - 1;
    if (world_s <= at(low).t_s) { return {&at(low), &at(low), 0.0}; }
    if (world_s >= at(high).t_s) { return {&at(high), &at(high), 0.0}; }
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (at(middle).t_s <= world_s ? low : high) = middle;
    }
    const WorldInstant& before = at(low);
    const WorldInstant& after = at(high);
    return {&before, &after, (world_s - before.t_s) / (after.t_s - before.t_s)};
}

void SteppedWorld::motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                          const std::array<std::span<double>, 3>& specific_force_m_s2) const {
    for (std::size_t i = 0; i < world_s.size(); ++i) {
        const auto [before, after, share] = between(world_s[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // By a parameter: clang 14 lets a lambda capture no structured binding.
            const auto on_line = [axis](double part, const Vector3& from, const Vector3& to) {
                return from[axis] + part * (to[axis] - from[axis]);
            };
            rate_rad_s[axis][i] = on_line(share, before->rate_rad_s, after->rate_rad_s);
            specific_force_m_s2[axis][i] =
                on_line(share, before->specific_force_m_s2, after->specific_force_m_s2);
        }
    }
}

void SteppedWorld::temperature(std::span<const double> world_s, std::span<double> temperature_C) const {
    for (std::size_t i = 0; i < world_s.size(); ++i) {
        const auto [before, after, share] = between(world_s[i]);
        temperature_C[i] = before->temperature_C + share * (after->temperature_C - before->temperature_C);
    }
}

}  // namespace gyrolog
