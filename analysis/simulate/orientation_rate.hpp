// Angular rate from a recorded orientation.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace gyrolog {

using Quaternion = std::array<double, 4>;  // w x y z

// The rotation vector (rad) of q, the shorter way round; q need not be of unit length. NaN gives NaN.
std::array<double, 3> rotation_vector(const Quaternion& q);

// Rates in rad/s in the sensor's axes, of samples that follow each other at `rate_hz`; `orientation` maps the
// sensor's axes to the world's. Each is the mean of the turn since the sample before and the turn to the
// next,
//   w_k = (phi(q_{k-1}* q_k) + phi(q_k* q_{k+1})) / 2 * rate_hz,   phi = rotation vector,
// from q' = q w / 2 (Sola, "Quaternion kinematics for the error-state Kalman filter", arXiv 1711.02508,
// section 4.6). At either end, and beside an unknown one (NaN), the one turn there is; NaN where there is
// none.
std::vector<std::array<double, 3>> orientation_rate(std::span<const Quaternion> orientation, double rate_hz);

}  // namespace gyrolog
