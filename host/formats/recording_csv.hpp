// A recording as text: a line that names the columns, then one line per sample.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"
#include "host/formats/recording_columns.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {

using CsvReadOptions = RecordingReadOptions;

// The text may be of any dialect: names by column_dialect.hpp, separators and comments by csv_table.hpp; the
// columns become a recording by recording_of().
//
// Errors: malformed (names the line and the column), invalid_argument (what the text lacks and which option
// gives it), and those of reading a file.
Result<Recording> read_recording_csv(const std::string& path, const CsvReadOptions& options = {});
Result<Recording> parse_recording_csv(std::string_view text, std::string name,
                                      const CsvReadOptions& options = {});

struct CsvWriteOptions {
    std::string rate_unit{};  // "dps" or "rad_s" for gyro and reference rates; empty: as the source had them,
                              // else dps
    // Columns whose digits beyond what the sensor resolves mean nothing: counts to a thousandth of their step
    // or finer, temperatures to 0.0001 degC, else 9 digits. All others are exact: the shortest number that
    // reads back as the same.
    std::vector<std::string> resolved{};
    TextGrowth growth = TextGrowth::whole;
};

// Time stamps as they came, or index / rate where none did. A column stopped_s comes last where there is a
// stop. Compressed by the name's ending. What was at `path` before stays until all is written.
Status write_recording_csv(const Recording& recording, const std::string& path,
                           const CsvWriteOptions& options = {});

// What a row of this text takes on average; 0 of a piece without rows.
double csv_row_bytes(const Recording& piece, const CsvWriteOptions& options = {});

// write_recording_csv() piece by piece: for recordings that no memory holds.
class RecordingCsvWriter {
public:
    static Result<RecordingCsvWriter> create(const std::string& path, CsvWriteOptions options);

    // The first piece decides the columns; the others have the same.
    Status append(const Recording& piece);
    // What was appended is in the file, if it is one that grows.
    Status flush();
    // Without close() nothing is left of a whole file.
    Status close();

private:
    RecordingCsvWriter(std::string path, CsvWriteOptions options, TextWriter file)
        : path_(std::move(path)), options_(std::move(options)), file_(std::move(file)) {}

    std::string path_;
    CsvWriteOptions options_;
    TextWriter file_;
    std::string text_;
    bool headed_ = false;
    bool tells_stops_ = false;
};

}  // namespace gyrolog
