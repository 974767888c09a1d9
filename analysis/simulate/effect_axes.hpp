// Which axes an entry of a model acts on, and where a recording has them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

inline constexpr std::array<const char*, 3> gyro_columns = {"gx", "gy", "gz"};

// An entry without axes acts on all.
inline bool acts_on(const EffectModel& entry, std::size_t axis) {
    return entry.axes.empty() || std::ranges::count(entry.axes, axis_names.at(axis)) != 0;
}

}  // namespace gyrolog
