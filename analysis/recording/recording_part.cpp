#include "analysis/recording/recording_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gyrolog {

std::vector<Segment> segments_within(std::span<const Segment> segments, double rate_hz,
                                     const TimeSpan& span) {
    std::vector<Segment> kept;
    if (segments.empty()) { return kept; }
    const std::int64_t origin = segments.front().first_index;
    const std::int64_t begin = origin + std::llround(span.from_s * rate_hz);
    const std::int64_t end = origin + std::llround(span.to_s * rate_hz);
    for (const Segment& segment : segments) {
        const std::int64_t from = std::max(segment.first_index, begin);
        const std::int64_t to = std::min(segment.first_index + static_cast<std::int64_t>(segment.count), end);
        if (from >= to) { continue; }
        kept.push_back({segment.first + static_cast<std::size_t>(from - segment.first_index),
                        static_cast<std::size_t>(to - from), from});
    }
    return kept;
}

Recording part_of(const Recording& recording, const TimeSpan& span) {
    const std::vector<Segment> kept = segments_within(recording.segments, recording.rate_hz, span);
    Recording part = rows_of(recording, kept);
    if (kept.empty()) {
        part.dropouts.clear();
        return part;
    }
    const std::int64_t origin = kept.front().first_index;
    for (Segment& segment : part.segments) { segment.first_index -= origin; }
    const double begin_s =
        static_cast<double>(origin - recording.segments.front().first_index) / recording.rate_hz;
    const double end_s = begin_s + part.duration_s();
    std::erase_if(part.dropouts,
                  [&](const Dropout& dropout) { return dropout.at_s <= begin_s || dropout.at_s >= end_s; });
    for (Dropout& dropout : part.dropouts) { dropout.at_s -= begin_s; }
    return part;
}

}  // namespace gyrolog
