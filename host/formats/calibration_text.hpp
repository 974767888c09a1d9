// A calibration for people, on 80 columns: each parameter with one sigma, then what to record next.
#pragma once

#include <string>

#include "analysis/calibrate/calibration.hpp"

namespace gyrolog {

std::string calibration_text(const Calibration& calibration);

// "not determined: ...", a line or more each, and "add: ..." once for neighbours of which it is the same;
// empty where all is determined.
std::string undetermined_text(const Calibration& calibration);

}  // namespace gyrolog
