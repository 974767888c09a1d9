// A recording from a MATLAB MAT-file, by libmatio: level 4, 5 and, where libmatio has it, 7.3.
//
// Each real numeric vector is a column, each matrix of samples as many, with _x, _y, _z behind its name. What
// they are is told by their names as in text (column_dialect.hpp). A scalar Fs, rate_hz and their like is the
// sampling rate where there is no time. Of MathWorks' example LoggedSingleAxisGyroscope.mat that are omega,
// in rad/s, and Fs; of gyrolog's own files what recording_mat.hpp says.
#pragma once

#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/formats/recording_columns.hpp"

namespace gyrolog {

// Errors: malformed (no MAT-file; cut off; columns of different lengths), invalid_argument (a unit or a rate
// is missing), and those of reading a file.
Result<Recording> read_recording_mat(const std::string& path, const RecordingReadOptions& options);

// Its two halves. The process that reads tells `descriptor` what libmatio finds in the file, or why nothing;
// libmatio may crash, or take all memory.
void tell_mat_file(const std::string& path, int descriptor);
// The program believes nothing of what it is told. Errors as above, without the file's name.
Result<Recording> recording_of_mat_answer(ByteView told, const std::string& path,
                                          RecordingReadOptions options);

}  // namespace gyrolog
