// Where the gyro of a recording rests.
#pragma once

#include "analysis/recording/recording.hpp"
#include "analysis/recording/recording_part.hpp"

namespace gyrolog {

// The longest part in which gx, gy and gz, as far as they are there, show no turn (still_part.hpp). Empty
// (from = to) when there is none.
TimeSpan gyro_rest(const Recording& recording);

}  // namespace gyrolog
