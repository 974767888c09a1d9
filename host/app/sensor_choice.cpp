#include "host/app/sensor_choice.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "analysis/noise/sensor_columns.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"

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

Result<ModelFile> model_of_sensor(ModelFile file, SensorKind sensor, const std::string& path) {
    if (sensor == SensorKind::gyro) { return file; }
    if (!file.model.accelerometer) {
        return Error{
            ErrorCode::failed,
            fmt::format("model '{}' has no accelerometer: `gyrolog analyze RECORDING --model FILE` writes "
                        "one of a recording that has both sensors",
                        path)};
    }
    file.model = accelerometer_as_gyro(file.model);
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
