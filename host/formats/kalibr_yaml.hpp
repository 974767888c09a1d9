// Kalibr's imu.yaml. Continuous-time densities (Kalibr's wiki, "IMU Noise Model"): noise density is N, random
// walk is K, never B. Kalibr has one value for all axes: the largest. A term that is not identified is left
// out, with a comment that says what it may be at most.
#pragma once

#include <string>

#include "host/formats/export_source.hpp"

namespace gyrolog {

std::string kalibr_yaml(const ExportSource& source);

}  // namespace gyrolog
