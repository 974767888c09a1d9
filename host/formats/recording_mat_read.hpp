// A recording from a MATLAB MAT-file, by libmatio: level 4, 5 and, where libmatio has it, 7.3.
//
// Each real numeric vector is a column, each matrix of samples as many, with _x, _y, _z behind its name. What
// they are is told by their names as in text (column_dialect.hpp). A scalar Fs, rate_hz and their like is the
// sampling rate where there is no time. Of MathWorks' example LoggedSingleAxisGyroscope.mat that are omega,
// in rad/s, and Fs; of gyrolog's own files what recording_mat.hpp says.
#pragma once

#include <string>

#include "host/base/result.hpp"
#include "host/formats/recording_columns.hpp"

namespace gyrolog {

// Errors: malformed (no MAT-file; cut off; columns of different lengths), invalid_argument (a unit or a rate
// is missing), and those of reading a file.
Result<Recording> read_recording_mat(const std::string& path, const RecordingReadOptions& options);

}  // namespace gyrolog
