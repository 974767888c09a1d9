// What is of a sensor at rest only, such as its noise model, is not made of a recording in motion.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"
#include "analysis/recording/disturbances.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct MotionRefusalOptions {
    // Of the rows: what moves for less is a touch, as a disturbance is (DisturbanceOptions::together_share).
    // The report warns of it.
    double touched_most = DisturbanceOptions().together_share;
    // Of an accelerometer at rest the mean over `mean_s` stays nearer to its median than this, which is a
    // tilt of six degrees. Vibration is no motion: it has no mean.
    double rest_most_g = 0.1;
    double mean_s = 0.25;
};

// Error: failed where the report is of a recording in motion (AnalysisReport::is_of_motion()), with what to
// do. `result` is what is not made then: "a model".
Status refuse_motion(const AnalysisReport& report, const Recording& recording, const std::string& path,
                     const std::string& result, const MotionRefusalOptions& options = {});

// An accelerometer, presented as a gyro (accelerometer_as_gyro.hpp), was turned or moved for longer than a
// touch.
bool is_moved(const Recording& as_gyro, const MotionRefusalOptions& options = {});

// Error: failed where such an accelerometer is_moved() and the recording does not tell the forces either:
// then nothing says what it should have shown.
Status refuse_moving_accelerometer(const Recording& as_gyro, const std::string& path,
                                   const MotionRefusalOptions& options = {});

// Error: failed where a gyro without a reference was turned for longer than a touch (share_turned()): its
// motion is no error of the sensor's, and nothing tells it from one. It says what judges the part at rest.
Status refuse_unreferenced_motion(const Recording& recording, const SensorModel& model,
                                  const std::string& path, const MotionRefusalOptions& options = {});

}  // namespace gyrolog
