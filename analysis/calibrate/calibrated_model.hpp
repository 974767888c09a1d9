// A calibration as a sensor model that can be simulated.
#pragma once

#include "analysis/calibrate/calibration.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// M, bias and the rests' white noise of both sensors; rate, step and range are the recording's, one of those
// that were calibrated (recorded_converter.hpp). What is not determined is as in a sensor without fault, and
// known as well as a data sheet tells it (knowledge.hpp). The
// temperature's part is an effect temp_linear, temp_quadratic or temp_cubic of each axis that follows, the
// specific force's an effect g_sensitivity.
SensorModel calibrated_model(const Calibration& calibration, const Recording& recording);

}  // namespace gyrolog
