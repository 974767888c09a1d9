// Where a denoiser's knowledge of its units comes from: a part at rest, and models.
#pragma once

#include <string>
#include <vector>

#include "analysis/denoise/denoise.hpp"
#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/recording/still_part.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Of each gyro axis the mean over the units, a value a row.
std::vector<std::vector<double>> gyro_means(const Recording& recording);

// The longest part in which the units' mean is still on all axes; empty when there is none.
TimeSpan still_part_of(const Recording& recording);

// The gyro columns of that part, where all units have samples. Error failed when it has too few of them.
Result<Recording> rows_at_rest(const Recording& recording, const TimeSpan& still);

// Puts the models of these files in place of what is known: one for all units, or one for each. An
// accelerometer is known as accelerometer_as_gyro() has it. Gives back what was taken for what in those of
// other simulators.
Result<std::vector<std::string>> use_model_files(std::vector<AxisKnowledge>& knowledge,
                                                 const std::vector<std::string>& paths, double rate_hz,
                                                 SensorKind sensor);

}  // namespace gyrolog
