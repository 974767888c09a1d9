// The model that people begin with: white noise and a bias.
#pragma once

#include <optional>

#include "analysis/recording/recording.hpp"
#include "analysis/recording/still_part.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct PlainModelOptions {
    double read_at_s = 1.0;  // where the line of slope -1/2 has the value N, IEEE Std 952-1997 annex C
};

struct PlainModel {
    SensorModel model;
    TimeSpan still;      // that it was taken from
    double tau_s = 0.0;  // at which N was read
};

// Of the longest part of the recording in which nothing turns: N is the Allan deviation at `read_at_s` (the
// nearest whole number of rows) times the root of that time, IEEE Std 952-1997 annex C, known as well as its
// equivalent degrees of freedom say; the bias is the mean. Rate, step and range are the recording's
// (recorded_converter.hpp). Nothing else is in it; of means, the model is of their samples. No value where
// there is no part of four seconds (still_part.hpp) or no gyro gx, gy or gz in rad/s.
std::optional<PlainModel> plain_model(const Recording& recording, const PlainModelOptions& options = {});

}  // namespace gyrolog
