#include "analysis/calibrate/inertial_signals.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "analysis/simulate/known_motion.hpp"
#include "analysis/simulate/recorded_world.hpp"

namespace gyrolog {
namespace {

using Columns = std::array<const Column*, 3>;

// Null where an axis is missing or has another unit.
Columns columns_of(const Recording& recording, const std::string& prefix, const std::string& unit) {
    Columns columns{};
    for (std::size_t axis = 0; axis < columns.size(); ++axis) {
        const Column* column = recording.find(prefix + axis_names[axis]);
        if (column == nullptr || column->unit != unit) { return {}; }
        columns[axis] = column;
    }
    return columns;
}

bool all_there(const Columns& columns) { return columns[0] != nullptr; }

VectorTrack track_of(const Columns& columns) {
    VectorTrack track;
    if (!all_there(columns)) { return track; }
    for (std::size_t axis = 0; axis < columns.size(); ++axis) { track[axis] = columns[axis]->values(); }
    return track;
}

Recording with_known_rows(Recording recording) {
    const Columns rate = columns_of(recording, "g", "rad/s");
    const Columns force = columns_of(recording, "a", "m/s^2");
    const auto is_known = [&](std::size_t row) {
        const auto finite = [&](const Column* column) {
            return column == nullptr || std::isfinite(column->value(row));
        };
        return std::ranges::all_of(rate, finite) && std::ranges::all_of(force, finite);
    };
    for (std::size_t row = 0; row < recording.rows(); ++row) {
        if (!is_known(row)) { return rows_of(recording, segments_where(recording.segments, is_known)); }
    }
    return recording;
}

// The world's time of each row.
std::vector<double> row_times_s(const Recording& recording) {
    std::vector<double> times_s;
    times_s.reserve(recording.rows());
    for (const Segment& segment : recording.segments) {
        const std::int64_t index = segment.first_index - recording.segments.front().first_index;
        for (std::size_t i = 0; i < segment.count; ++i) {
            times_s.push_back(static_cast<double>(index + static_cast<std::int64_t>(i)) / recording.rate_hz);
        }
    }
    return times_s;
}

}  // namespace

InertialSignals inertial_signals(Recording recording) {
    InertialSignals signals;
    auto known = std::make_shared<const Recording>(with_known_motion(with_known_rows(std::move(recording))));
    signals.rate_rad_s = track_of(columns_of(*known, "g", "rad/s"));
    signals.force_m_s2 = track_of(columns_of(*known, "a", "m/s^2"));
    if (known->rows() > 0) {
        const RecordedWorld world(known);
        // Three axes: one that is not measured would be taken not to turn.
        bool is_whole = world.has_reference();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            is_whole = is_whole && !world.rate_rad_s(axis).empty();
        }
        for (std::size_t axis = 0; is_whole && axis < 3; ++axis) {
            signals.reference_rad_s[axis] = world.rate_rad_s(axis);
        }
        if (world.has_temperature()) {
            const std::vector<double> times_s = row_times_s(*known);
            signals.temperature_C.resize(times_s.size());
            world.temperature(times_s, signals.temperature_C);
        }
    }
    signals.recording = *known;
    return signals;
}

double mean_of(const std::vector<double>& track, std::size_t first, std::size_t rows) {
    const auto begin = track.begin() + static_cast<std::ptrdiff_t>(first);
    // From the first value on: a sum of many equal large numbers would round.
    const double origin = *begin;
    const double sum =
        std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(rows), 0.0,
                        [&](double so_far, double value) { return so_far + (value - origin); });
    return origin + sum / static_cast<double>(rows);
}

Vector3 mean_of(const VectorTrack& track, std::size_t first, std::size_t rows) {
    Vector3 mean{};
    for (std::size_t axis = 0; axis < mean.size(); ++axis) { mean[axis] = mean_of(track[axis], first, rows); }
    return mean;
}

}  // namespace gyrolog
