// A recording and its analysis as a MATLAB MAT-file, level 5, by libmatio.
//
//   t                  s, a column; rate_hz
//   gyro               rad/s, a column each; gyro_axes: their names; other columns under their own names, SI
//   units temperature_degC   where there is one analysis.AXIS      bias, bias_expanded_uncertainty; tau,
//   adev, adev_lo, adev_hi, edf; N, B, K, Q, R, each with
//                      identified, value, sd, lo, hi, upper; rad and s
#pragma once

#include <string>

#include "host/base/result.hpp"
#include "host/formats/export_source.hpp"

namespace gyrolog {

// The file is replaced whole or not at all. Errors: unsupported (a column of more than 2 GB, which level 5
// cannot hold) and those of writing.
Status write_recording_mat(const ExportSource& source, const std::string& path);

}  // namespace gyrolog
