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
// sensor's axes to the world's, any sign of q. Each is the slope of the straight line of least squares
// through the angles turned at the rows within 50 ms on either side (at least one row); the angle turned is
// the sum of the turns
//   phi(q_{k-1}* q_k),   phi = rotation vector,
// each in the axes the sensor has meanwhile, so that the slope is a weighted mean of the rates in those axes:
// q' = q w / 2 (Sola, "Quaternion kinematics for the error-state Kalman filter", arXiv 1711.02508, section
// 4.6). What swings at f comes out by 3 (sin u - u cos u) / u^3, u = 2 pi f 50 ms: 1 % less at 1 Hz, 3 dB
// less at 5.8 Hz. Independent errors of the orientation of sd s leave s rate_hz sqrt(3 / (m (m + 1) (2m +
// 1))) with m rows on either side.
//
// Rows that are unknown (NaN) for no more than 50 ms get a rate from those around them. Longer, and before
// the first and after the last known one, the rate is NaN and nothing is fitted across; beside such rows the
// window has one side only, and less of the noise is taken off.
//
// No faster than half a turn from a known row to the next.
std::vector<std::array<double, 3>> orientation_rate(std::span<const Quaternion> orientation, double rate_hz);

}  // namespace gyrolog
