// A recording as text: one header line, then one line per sample; the unit stands in the column's name.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {

struct CsvReadOptions {
    std::optional<double> rate_hz{};  // given by the user: time stamps in the file are then ignored
    std::optional<double> lsb_dps{};  // scale of gyro columns in counts
    std::optional<double>
        lsb_g{};  // scale of accelerometer columns in counts; without it they stay in counts
    // Gyro counts without lsb_dps are an error, because every unit would be wrong; with this they come as
    // unit "lsb".
    bool allow_unscaled_counts = false;
    // Reading ends soon after so many.
    std::size_t rows_most = std::numeric_limits<std::size_t>::max() - 1;
    // More: means of so many lines, whether or not samples are missing between them, of those that have
    // all; a row is missing where fewer than half have. Otherwise as means_of() has them. Only rows take
    // memory.
    std::size_t samples_per_row = 1;
    bool with_accelerometer = true;  // without it, its columns are not read
    bool needs_gyro = true;          // text without a gyro column is an error, even with an accelerometer
};

// Numbers keep the unit and the digits that the text has (Column::source_unit). Counts that are whole numbers
// of 16 bits become counts. An angle becomes a rate: its difference from the sample before, times the rate;
// so does an increment. The first sample after a hole then has no rate and counts as missing.
//
// A row where any gyro field is empty or NaN is a missing sample; in other columns such a field stays NaN.
// Without a gyro column the accelerometer's fields decide.
// Columns of unknown name are ignored, with one warning that lists them.
//
// A hole is a loss, unless a column stopped_s says behind it, in its first sample, that the user had stopped
// the board meanwhile, and for how long: that is a dropout of the cause stopped_cause, and nobody misses it.
// It is not looked at where rows are means.
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

// The same, piece by piece: for recordings that no memory holds.
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
