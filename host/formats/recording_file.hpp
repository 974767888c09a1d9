// A recording in any kind of file but a capture.
#pragma once

#include <string>

#include "host/base/result.hpp"
#include "host/formats/recording_columns.hpp"

namespace gyrolog {

// .npy and .mat are told by how they begin, and by their ending where that says nothing; all else is text.
// Errors: those of read_recording_npy(), read_recording_mat() and read_recording_csv().
Result<Recording> read_recording_file(const std::string& path, const RecordingReadOptions& options);

}  // namespace gyrolog
