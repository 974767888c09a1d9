// A calibration as a header for C (C99 and C++): the numbers, and functions that apply them.
//
//   a = C_a (raw - b_a - p_a(T))
//   w = C_g (raw - b_g - p_g(T) - K a)
// C = M^-1, p a polynomial about the reference temperature, T kept within the range that was seen; SI units,
// in the accelerometer's orthogonal axes (accelerometer_fit.hpp, gyro_fit.hpp). What is not determined is the
// identity or 0, and the header says so.
#pragma once

#include <string>

#include "analysis/calibrate/calibration.hpp"

namespace gyrolog {

std::string calibration_c_header(const Calibration& calibration);

}  // namespace gyrolog
