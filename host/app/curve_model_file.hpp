// The sensor model that printed curves give.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/curve_report.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct ModelOfCurves {
    SensorModel model;
    std::vector<std::string> warnings;  // what a curve does not tell
};

// Of the curves named x, y and z; an axis without a curve has no noise. Gauss-Markov noise becomes an effect.
// Without `rate_hz` the shortest averaging time is taken for the sampling interval. Error: none of the curves
// has such a name.
Result<ModelOfCurves> model_of_curves(const CurveReport& report, std::optional<double> rate_hz);

}  // namespace gyrolog
