// The stretches of a recording in which something outside moved the gyro, as the disturbance effect leaves
// them out and its estimator counts them.
#pragma once

#include <vector>

#include "analysis/recording/disturbances.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Signals are the axes in their order; a recording of means has none.
std::vector<Disturbance> gyro_disturbances(const Recording& recording);

}  // namespace gyrolog
