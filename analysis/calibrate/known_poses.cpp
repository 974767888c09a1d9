#include "analysis/calibrate/known_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/calibrate/inertial_signals.hpp"
#include "analysis/calibrate/rests.hpp"
#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/recorded_orientation.hpp"

namespace gyrolog {
namespace {

// 0 of 0.
Vector3 direction_of(const Vector3& vector) {
    const double length = norm(vector);
    return length > 0.0 ? scaled(vector, 1.0 / length) : vector;
}

Vector3 turned_to_world(const Quaternion& orientation, const Vector3& vector) {
    const auto [w, x, y, z] = orientation;
    const Vector3 part{x, y, z};
    const Vector3 aside = cross(part, vector);
    const Vector3 turn = sum_of(scaled(aside, w), cross(part, aside));
    return sum_of(vector, scaled(turn, 2.0 / (w * w + dot(part, part))));
}

// Sums over the rows of a rest in which the orientation is known.
struct PoseSums {
    Vector3 force{};  // that should be there, in the sensor's axes
    Vector3 up{};     // the measured force's direction, in the world's axes
};

PoseSums sums_of(const Rest& rest, const std::vector<Quaternion>& orientation) {
    PoseSums sums;
    const Vector3 measured = direction_of(rest.force_m_s2);
    for (std::size_t row = rest.first; row < rest.first + rest.rows; ++row) {
        const Vector3 force = force_at_rest(orientation[row]);
        if (!std::isfinite(force[0])) { continue; }
        sums.force = sum_of(sums.force, force);
        sums.up = sum_of(sums.up, turned_to_world(orientation[row], measured));
    }
    return sums;
}

std::vector<Quaternion> orientation_by_row(const Recording& recording) {
    std::vector<Quaternion> orientation;
    for (const Segment& segment : recording.segments) {
        const std::vector<Quaternion> part = recorded_orientation(recording, segment);
        orientation.insert(orientation.end(), part.begin(), part.end());
    }
    return orientation;
}

}  // namespace

RestsInPoses rests_in_poses(Recording recording) {
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(std::move(recording)));
    const Recording& all = signals.front().recording;
    RestsInPoses posed;
    std::vector<bool> in_pose(all.rows(), false);
    std::array<std::vector<double>, 3> force_m_s2;
    if (signals.front().has_force()) {
        const std::vector<Quaternion> orientation = orientation_by_row(all);
        for (const Rest& rest : find_phases(signals).rests) {
            const PoseSums sums = sums_of(rest, orientation);
            if (!(norm(sums.force) > 0.0)) { continue; }
            const Vector3 force = scaled(direction_of(sums.force), standard_gravity_m_s2);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                force_m_s2.at(axis).insert(force_m_s2.at(axis).end(), rest.rows, force.at(axis));
            }
            const auto begin = in_pose.begin() + static_cast<std::ptrdiff_t>(rest.first);
            std::fill(begin, begin + static_cast<std::ptrdiff_t>(rest.rows), true);
            posed.up = sum_of(posed.up, direction_of(sums.up));
            posed.resting_s += rest.duration_s;
            ++posed.rests;
        }
    }
    posed.up = direction_of(posed.up);
    posed.recording =
        rows_of(all, segments_where(all.segments, [&](std::size_t row) { return in_pose[row]; }));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        posed.recording.columns.push_back(
            {std::string("ref_a") + axis_names.at(axis), "m/s^2", std::move(force_m_s2.at(axis))});
    }
    return posed;
}

}  // namespace gyrolog
