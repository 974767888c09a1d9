// Process noise for a Kalman filter with the states (angle, gyro bias): d(angle)/dt = measured rate - bias.
// gyrolog-filter-tuning/1; SI units, each in its key's "unit".
//
//   white rate noise    Q_angle = N^2 dt
//   rate random walk    Q_bias = K^2 dt
//   both together       [[N^2 dt + K^2 dt^3 / 3, -K^2 dt^2 / 2], [-K^2 dt^2 / 2, K^2 dt]]
//   Gauss-Markov for B  db/dt = -b / T + w, density of w 2 sigma^2 / T; a step: phi = exp(-dt / T),
//                       Q = sigma^2 (1 - phi^2)
//
// Flicker noise has no finite-dimensional filter. The Gauss-Markov process in its place has its Allan
// deviation's maximum, 0.617 sigma at 1.89 T (IEEE Std 952-1997 C.1.5), at the flat of the curve, sqrt(2 ln 2
// / pi) B at tau.
#pragma once

#include <string>

#include "host/formats/export_source.hpp"

namespace gyrolog {

// A term that is not identified has "state": "not_identifiable" and no matrix.
std::string filter_tuning_json(const ExportSource& source);

}  // namespace gyrolog
