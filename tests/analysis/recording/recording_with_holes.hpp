// A small recording for tests of what cuts and joins rows.
#pragma once

#include <numeric>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Ten rows in three segments: 0-3, then one missing, 4-5, then four missing, 6-9.
inline Recording with_holes() {
    Recording recording;
    recording.rate_hz = 10.0;
    Column column{.name = "gx", .unit = "rad/s", .data = std::vector<double>(10)};
    std::iota(std::get<1>(column.data).begin(), std::get<1>(column.data).end(), 0.0);
    recording.columns = {column};
    recording.t_s = {0.0, 0.1, 0.2, 0.3, 0.5, 0.6, 1.1, 1.2, 1.3, 1.4};
    recording.segments = {{0, 4, 0}, {4, 2, 5}, {6, 4, 11}};
    recording.dropouts = {{0.4, 1, "link"}, {0.7, 4, "link"}};
    return recording;
}

}  // namespace gyrolog
