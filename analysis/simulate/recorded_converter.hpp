// The converter of a sensor, as far as a recording shows it.
#pragma once

#include <optional>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Of an accelerometer in m/s^2.
struct RecordedConverter {
    double step_rad_s = 0.0;  // 0: not known
    double full_scale_rad_s = 0.0;
    double saturation_rad_s = 0.0;
};

// Of a column in rad/s, or in m/s^2 of an accelerometer, whose numbers are `step` apart, 0 for none. Numbers
// on a grid come from 16 bits like counts, if 16 bits reach the largest of them. Otherwise only the largest
// is known: the range is the smallest usual one of such sensors, `range_least` or more, that holds it.
RecordedConverter recorded_converter(const Column& column, double step, double range_least = 0.0,
                                     SensorKind sensor = SensorKind::gyro);

// Of the first gyro's columns in rad/s: the first axis whose numbers are on a grid, else the range of all. No
// value where there is no such column.
std::optional<RecordedConverter> recorded_converter(const Recording& recording);

}  // namespace gyrolog
