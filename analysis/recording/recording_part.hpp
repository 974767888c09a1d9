// What a recording holds between two times.
#pragma once

#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct TimeSpan {
    double from_s = 0.0;  // from the first sampling instant
    double to_s = 0.0;
};

// The segments' part between two times.
std::vector<Segment> segments_within(std::span<const Segment> segments, double rate_hz, const TimeSpan& span);

// The samples from `from_s` on and before `to_s`, as a recording of its own: times and the grid count from
// its first sample, dropouts are those between its samples, stamps stay as they came. Without rows where the
// recording has none there.
Recording part_of(const Recording& recording, const TimeSpan& span);

}  // namespace gyrolog
