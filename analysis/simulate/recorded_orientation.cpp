#include "analysis/simulate/recorded_orientation.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {
namespace {

constexpr std::array<const char*, 4> orientation_columns = {"ref_qw", "ref_qx", "ref_qy", "ref_qz"};

}  // namespace

bool has_orientation(const Recording& recording) {
    return std::ranges::all_of(orientation_columns,
                               [&](const char* name) { return recording.find(name) != nullptr; });
}

std::vector<Quaternion> recorded_orientation(const Recording& recording, const Segment& segment) {
    std::vector<Quaternion> orientation(segment.count);
    for (std::size_t part = 0; part < orientation_columns.size(); ++part) {
        const Column& column = *recording.find(orientation_columns.at(part));
        for (std::size_t i = 0; i < segment.count; ++i) {
            orientation[i].at(part) = column.value(segment.first + i);
        }
    }
    return orientation;
}

Vector3 force_at_rest(const Quaternion& orientation) {
    const auto [w, x, y, z] = orientation;
    const double scale = standard_gravity_m_s2 / (w * w + x * x + y * y + z * z);
    return {2.0 * (x * z - w * y) * scale, 2.0 * (y * z + w * x) * scale,
            (w * w - x * x - y * y + z * z) * scale};
}

Recording with_force_at_rest(const Recording& recording) {
    std::array<std::vector<double>, 3> force_m_s2;
    for (const Segment& segment : recording.segments) {
        for (const Quaternion& orientation : recorded_orientation(recording, segment)) {
            const Vector3 force = force_at_rest(orientation);
            for (std::size_t axis = 0; axis < 3; ++axis) { force_m_s2.at(axis).push_back(force.at(axis)); }
        }
    }
    Recording posed;
    posed.name = recording.name;
    posed.rate_hz = recording.rate_hz;
    posed.segments = recording.segments;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        posed.columns.push_back(
            {std::string("a") + axis_names.at(axis), "m/s^2", std::move(force_m_s2.at(axis))});
    }
    if (const Column* temperature = recording.find("temp")) { posed.columns.push_back(*temperature); }
    return posed;
}

}  // namespace gyrolog
