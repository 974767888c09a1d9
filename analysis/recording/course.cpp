#include "analysis/recording/course.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gyrolog {

std::vector<double> course_of(const Recording& recording, const Column& column, std::size_t parts) {
    std::vector<double> means(parts, std::numeric_limits<double>::quiet_NaN());
    if (recording.segments.empty()) { return means; }
    const std::int64_t begin = recording.segments.front().first_index;
    const Segment& last = recording.segments.back();
    const auto instants =
        static_cast<double>(last.first_index + static_cast<std::int64_t>(last.count) - begin);
    std::vector<double> sums(parts, 0.0);
    std::vector<std::size_t> counts(parts, 0);
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const double value = column.value(segment.first + i);
            if (std::isnan(value)) { continue; }
            const auto instant = static_cast<double>(segment.first_index - begin) + static_cast<double>(i);
            const double part = std::floor(instant / instants * static_cast<double>(parts));
            const std::size_t at = std::min(static_cast<std::size_t>(part), parts - 1);
            sums[at] += value;
            ++counts[at];
        }
    }
    for (std::size_t part = 0; part < parts; ++part) {
        if (counts[part] > 0) { means[part] = sums[part] / static_cast<double>(counts[part]); }
    }
    return means;
}

}  // namespace gyrolog
