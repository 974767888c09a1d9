// The columns of a recording that belong to a sensor.
#pragma once

#include <optional>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// By its name: "gx" ... of a gyro, "ax" ... of an accelerometer, with a number behind it of an array's
// others.
bool is_of(SensorKind sensor, const Column& column);

// The rows in which every column of the accelerometer that has a scale has a value; nothing where all rows
// are such ones. The others are missing without being dropouts.
std::optional<Recording> rows_with_accelerometer(const Recording& recording);

}  // namespace gyrolog
