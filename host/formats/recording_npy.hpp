// A recording as a NumPy array: .npy of version 1.0 to 3.0, as numpy.save writes it.
//
// Source of the form: NumPy Enhancement Proposal 1 (A Simple File Format for NumPy Arrays), and
// numpy.lib.format of NumPy 1.17 for version 3.0, whose header is UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "host/base/result.hpp"
#include "host/formats/recording_columns.hpp"

namespace gyrolog {

enum class NpyType { float32, float64, int16, int32 };

struct NpyHeader {
    NpyType type = NpyType::float64;
    bool column_by_column = false;  // "Fortran order"; else row by row
    std::size_t rows = 0;
    std::size_t columns = 1;
    std::size_t header_bytes = 0;  // before the numbers

    std::size_t number_bytes() const;
};

// `begin`: the file, or as much of it as numbers may begin in. Errors: malformed (no .npy, cut, or beyond the
// limits), unsupported (big endian; another type; more than two dimensions), which say what to save instead.
Result<NpyHeader> parse_npy_header(std::string_view begin);

// The names come from `options.choice.columns`, by position. Errors: those of the header; malformed (bytes
// are missing, or left), invalid_argument (no names; no rate; no unit) and those of reading a file.
Result<Recording> read_recording_npy(const std::string& path, const RecordingReadOptions& options);
Result<Recording> parse_recording_npy(std::string_view file, std::string name,
                                      const RecordingReadOptions& options);

bool begins_as_npy(std::string_view file);

}  // namespace gyrolog
