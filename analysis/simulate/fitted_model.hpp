// The sensor model that an analysis hands on: what was identified, with its uncertainty, and nothing else.
#pragma once

#include "analysis/noise/analyze.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// Of the first gyro on each axis. A term that was not identified is 0: the simulation shall not have what the
// record does not show. Gauss-Markov noise and lines become effects of the model, and so does a drift with
// the temperature that was taken off. The stamps' scatter, where they mark sampling instants, and the
// thermometer's noise are the recording's; the rate is known to 50 ppm at best, as the clock behind the
// stamps is. Needs a report in rad/s (not counts without a scale). The accelerometer is in it where the
// report has one with a scale. Its bias is 0: gravity hides it.
SensorModel fitted_model(const AnalysisReport& report, const Recording& recording);

}  // namespace gyrolog
