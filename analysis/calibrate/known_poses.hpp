// An accelerometer that is set down in several poses which are known: where it rests, gravity in its axes is
// what it should show, and nothing tells what it should have shown in between.
#pragma once

#include <cstddef>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct RestsInPoses {
    // The rows of the rests (rests.hpp); what is between them is missing without being a dropout. Three
    // columns more, ref_ax ref_ay ref_az in m/s^2: force_at_rest() (recorded_orientation.hpp), its mean over
    // a rest, in which nothing turns.
    Recording recording;
    std::size_t rests = 0;
    double resting_s = 0.0;
    // The mean direction of the measured forces, turned into the world's axes: of a world whose z axis points
    // upward, (0, 0, 1) but for the errors of both. 0 without a rest.
    Vector3 up{};
};

// `recording` has_orientation(), and ax ay az in m/s^2; otherwise there are no rests. An orientation that is
// not known (NaN) tells nothing; a rest in which it is known nowhere is left out.
RestsInPoses rests_in_poses(Recording recording);

}  // namespace gyrolog
