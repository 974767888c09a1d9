// The converter of a sensor, as far as a recording shows it.
#pragma once

#include <optional>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct RecordedConverter {
    double step_rad_s = 0.0;  // 0: not known
    double full_scale_rad_s = 0.0;
    double saturation_rad_s = 0.0;
};

// Of a gyro's column in rad/s whose numbers are `step_rad_s` apart, 0 for none. Numbers on a grid come from
// 16 bits like counts, if 16 bits reach the largest of them. Otherwise only the largest is known: the range
// is the smallest usual one, `range_least_rad_s` or more, that holds it.
RecordedConverter recorded_converter(const Column& column, double step_rad_s, double range_least_rad_s = 0.0);

// Of the first gyro's columns in rad/s: the first axis whose numbers are on a grid, else the range of all. No
// value where there is no such column.
std::optional<RecordedConverter> recorded_converter(const Recording& recording);

}  // namespace gyrolog
