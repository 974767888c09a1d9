// The diagnosis of an accelerometer, which is diagnosed as a gyro (accelerometer_as_gyro.hpp).
#pragma once

#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The function puts an answer about accelerometer_as_gyro() of a recording and of `model` in an
// accelerometer's terms: parameters in g, places by force, the causes in the accelerometer of the corrected
// model, and nothing of the effects that an accelerometer cannot show, or that only known forces show where
// there are none.
Diagnosis diagnosis_of_accelerometer(Diagnosis as_gyro, const SensorModel& model,
                                     Exposure exposure = Exposure::upright);

// The function returns the gyro's causes that the accelerometer has as well, at the same place: the same
// line, the same instant, the same fault of the stamps or of the frames. They come from what both share, the
// board or what it stands on.
std::vector<std::string> shared_causes(const Diagnosis& gyro, const Diagnosis& accelerometer);

}  // namespace gyrolog
