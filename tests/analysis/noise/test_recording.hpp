// Samples as a recording without holes, one column an axis: x, y, z.
#pragma once

#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog::test {

inline Recording recording_of(std::vector<std::vector<double>> axes, double rate_hz) {
    Recording recording;
    recording.name = "test";
    recording.rate_hz = rate_hz;
    recording.segments = {{0, axes.front().size(), 0}};
    const char* names[] = {"gx", "gy", "gz"};
    for (std::size_t i = 0; i < axes.size(); ++i) {
        recording.columns.push_back({names[i], "rad/s", std::move(axes[i]), 1.0, 0.0, "rad_s"});
    }
    return recording;
}

}  // namespace gyrolog::test
