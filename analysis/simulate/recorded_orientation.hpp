// The orientation that a recording tells (ref_qw ref_qx ref_qy ref_qz), and what gravity is to a sensor in
// it.
#pragma once

#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/orientation_rate.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

bool has_orientation(const Recording& recording);

// One a row of the segment, NaN where it is not known. The recording has_orientation().
std::vector<Quaternion> recorded_orientation(const Recording& recording, const Segment& segment);

// The specific force in m/s^2, in the sensor's axes, of a sensor at rest: standard gravity upward, which is
// the world's z axis. `orientation` maps the sensor's axes to the world's; of any length. NaN gives NaN.
Vector3 force_at_rest(const Quaternion& orientation);

// What an accelerometer would be exposed to if the recording, which has_orientation(), had been at rest at
// each of its instants: its grid with ax ay az of force_at_rest(), and its temperature.
Recording with_force_at_rest(const Recording& recording);

}  // namespace gyrolog
