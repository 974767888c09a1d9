// The model that people begin with: white noise and a bias.
#pragma once

#include <optional>

#include "analysis/recording/recording.hpp"
#include "analysis/recording/still_part.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct PlainModel {
    SensorModel model;
    TimeSpan still;  // that it was taken from
};

// Of the longest part of the recording in which nothing turns: N is the Allan deviation at 1 s (at one sample
// of a slower sensor) times the root of that time, IEEE Std 952-1997 annex C, known as well as its equivalent
// degrees of freedom say; the bias is the mean. Rate, step and range are the recording's
// (recorded_converter.hpp), the reference's noise is that of its samples there (neighbour_scatter.hpp).
// Nothing else is in it; of means, the model is of their samples. No value where there is no part of four
// seconds (still_part.hpp) or no gyro gx, gy or gz in rad/s.
std::optional<PlainModel> plain_model(const Recording& recording);

}  // namespace gyrolog
