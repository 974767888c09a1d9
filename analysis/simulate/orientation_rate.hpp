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
// sensor's axes to the world's, any sign of q. Each is the slope of the cubic of least squares through the
// angles turned at the rows within 50 ms on either side (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964)
// 1627); of a straight line where there are fewer than six rows (at least one on either side) or most of them
// are on one side. The angle turned is the sum of the turns
//   phi(q_{k-1}* q_k),   phi = rotation vector,
// each in the axes the sensor has meanwhile, so that the slope is a weighted mean of the rates in those axes:
// q' = q w / 2 (Sola, "Quaternion kinematics for the error-state Kalman filter", arXiv 1711.02508, section
// 4.6). With j the spherical Bessel functions and u = 2 pi f 50 ms, what swings at f comes out by
//   (3 j_1(u) + 10.5 j_3(u)) / u = 1 - u^4/504 + ...:
// 0.03 % less at 2 Hz, 1 % less at 4.8 Hz, 3 dB less at 12.5 Hz. Independent errors of the orientation of sd
// s leave nearly 2.5 s rate_hz sqrt(3 / (m (m + 1) (2m + 1))) with m rows on either side, m large.
//
// Rows that are unknown (NaN) for no more than 50 ms get a rate from those around them. Longer, and before
// the first and after the last known one, the rate is NaN and nothing is fitted across; beside such rows the
// window has one side only, and less of the noise is taken off.
//
// No faster than half a turn from a known row to the next.
std::vector<std::array<double, 3>> orientation_rate(std::span<const Quaternion> orientation, double rate_hz);

// Rates in rad/s at the rows, by the central difference of fourth order of the angle turned (M. Abramowitz,
// I. Stegun, Handbook of Mathematical Functions, table 25.2): what swings at f comes out by
//   1 - w^4/30 + ...,   w = 2 pi f / rate_hz.
// Unlike orientation_rate() it takes no frequency off, and none of the orientation's errors: their sum over
// rows that follow each other is that of the ends, so that a mean over m rows has nearly s rate_hz sqrt(2) /
// m of independent errors of sd s. Rows that are unknown (NaN) between known ones turn evenly; those before
// the first and after the last are NaN. No faster than half a turn from a known row to the next.
std::vector<std::array<double, 3>> turn_rate(std::span<const Quaternion> orientation, double rate_hz);

}  // namespace gyrolog
