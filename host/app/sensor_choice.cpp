#include "host/app/sensor_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "analysis/calibrate/known_poses.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/noise/sensor_columns.hpp"
#include "host/app/quantity.hpp"
#include "host/base/counted.hpp"

namespace gyrolog {

std::string no_accelerometer_text() {
    return "there is no accelerometer in it: a capture has one if its board sends it, and text if it has "
           "columns "
           "such as ax_g, ay_g, az_g (or _m_s2, _lsb)";
}

Result<Recording> recording_of_sensor(Recording recording, SensorKind sensor, const std::string& path) {
    if (sensor == SensorKind::gyro) { return recording; }
    if (auto seen = accelerometer_as_gyro(recording)) { return *std::move(seen); }
    const bool has_counts = std::ranges::any_of(
        recording.columns, [](const Column& column) { return is_of(SensorKind::accelerometer, column); });
    return Error{ErrorCode::failed,
                 fmt::format("'{}': {}", path,
                             has_counts ? "the accelerometer has counts: give their scale with --lsb-g"
                                        : no_accelerometer_text())};
}

namespace {

// Which of the world's axes the forces point along: "+z".
std::string nearest_axis(const Vector3& up) {
    const auto* largest =
        std::ranges::max_element(up, {}, [](double component) { return std::abs(component); });
    return std::string(*largest < 0.0 ? "-" : "+") +
           axis_names.at(static_cast<std::size_t>(largest - up.begin()));
}

Status check_poses(const RestsInPoses& posed, const std::string& path) {
    if (posed.rests == 0) {
        return Error{
            ErrorCode::failed,
            fmt::format("'{}': the accelerometer is turned or moved and rests nowhere for a second with "
                        "an orientation that is known and columns of x, y and z: it is diagnosed in "
                        "poses in which it rests",
                        path)};
    }
    if (const std::string axis = nearest_axis(posed.up); axis != "+z") {
        return Error{
            ErrorCode::failed,
            fmt::format("'{}': turned by the orientation (ref_qw ...), what the accelerometer shows at "
                        "rest points along the world's {} axis: the world's z axis has to point "
                        "upward, and the quaternion to map the sensor's axes to the world's",
                        path, axis)};
    }
    return {};
}

}  // namespace

Result<Recording> accelerometer_in_poses(Recording recording, const std::string& path) {
    const double duration_s = recording.duration_s();
    RestsInPoses posed = rests_in_poses(std::move(recording));
    GYROLOG_CHECK(check_poses(posed, path));
    posed.recording.warnings.push_back(fmt::format(
        "the accelerometer is judged where it rests, {} in {} of {}, against gravity in the poses "
        "that the orientation tells; the mean of what it shows there is {:.2g} deg off the world's "
        "z axis, and an error of the orientation is taken for one of the sensor",
        counted(posed.rests, "time"), format_duration(posed.resting_s), format_duration(duration_s),
        std::acos(std::min(1.0, posed.up[2])) * deg_per_rad));
    return recording_of_sensor(std::move(posed.recording), SensorKind::accelerometer, path);
}

Result<ModelFile> model_of_sensor(ModelFile file, SensorKind sensor, const std::string& path,
                                  Exposure exposure) {
    if (sensor == SensorKind::gyro) { return file; }
    if (!file.model.accelerometer) {
        return Error{
            ErrorCode::failed,
            fmt::format("model '{}' has no accelerometer: `gyrolog analyze RECORDING --model FILE` writes "
                        "one of a recording that has both sensors",
                        path)};
    }
    file.model = accelerometer_as_gyro(file.model, exposure);
    file.unstated = {.rate = file.unstated.rate};
    file.unrated_sd_rad_s = {};
    return file;
}

std::string path_of_accelerometer(const std::string& path) {
    std::filesystem::path own(path);
    return own.replace_extension(".accelerometer" + std::filesystem::path(path).extension().string())
        .string();
}

}  // namespace gyrolog
