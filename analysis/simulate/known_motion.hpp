// A sensor is judged by what it says of a motion that is known.
#pragma once

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct KnownMotionOptions {
    // How long a sensor shows what it did before: ten times the largest plausible latency
    // (effects/latency.cpp). The rate of an orientation is fitted over 0.05 s on either side
    // (orientation_rate.hpp), so it is known within that, too.
    double memory_s = 0.1;
};

// The rows that are farther than `memory_s` from every row whose reference rate is unknown for longer than
// RecordedWorld joins it: a sensor that lags shows what moved before, and a rate next to an unknown one is an
// extrapolation of the reference's. A warning says how many are left out. The recording as it is where the
// reference is known, or where there is none.
Recording with_known_motion(Recording recording, const KnownMotionOptions& options = {});

}  // namespace gyrolog
