// The option --sensor of commands that hold a recording against a model: its gyro, or its accelerometer,
// which is presented to them as a gyro (accelerometer_as_gyro.hpp).
#pragma once

#include <optional>
#include <string>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "host/app/command.hpp"
#include "host/base/result.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {

inline constexpr const char* lsb_g_help = "Scale of accelerometer columns that are counts (_lsb)";

// What a recording without an accelerometer is told.
std::string no_accelerometer_text();

// Error: failed where the recording has no accelerometer, or one in counts without a scale.
Result<Recording> recording_of_sensor(Recording recording, SensorKind sensor, const std::string& path);

// The accelerometer of a recording that has_orientation(), where it rests, as accelerometer_as_gyro() has it,
// with the forces that it should show (known_poses.hpp); a warning says where that is. Error: failed where it
// rests nowhere, lacks an axis, or the orientation contradicts gravity.
Result<Recording> accelerometer_in_poses(Recording recording, const std::string& path);

// Error: failed where the model has none.
Result<ModelFile> model_of_sensor(ModelFile file, SensorKind sensor, const std::string& path,
                                  Exposure exposure = Exposure::upright);

// "night.accelerometer.png" beside "night.png".
std::string path_of_accelerometer(const std::string& path);

}  // namespace gyrolog
