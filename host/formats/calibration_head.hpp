// The head of a file that a calibration is exported to.
#pragma once

#include <string>
#include <string_view>

#include "analysis/calibrate/calibration.hpp"

namespace gyrolog {

// Which recordings, and what is not determined; each line behind `sign`.
std::string calibration_head(const Calibration& calibration, std::string_view sign);

// What a program loses that has an offset and a scale for each axis only; empty where nothing is lost.
std::string loss_without_matrix(const Calibration& calibration, std::string_view sign);

}  // namespace gyrolog
