// Columns of numbers from a file of any kind, and the recording that they are.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"
#include "host/formats/understood_columns.hpp"

namespace gyrolog {

struct RecordingReadOptions {
    std::optional<double> rate_hz{};  // given by the user: time stamps in the file are then ignored
    std::optional<double> lsb_dps{};  // scale of gyro columns in counts
    // Scale of accelerometer columns in counts; without it they stay in counts.
    std::optional<double> lsb_g{};
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
    ColumnChoice choice{};           // what the user says of the columns
};

// A column that was understood, with its numbers: NaN where one is missing.
struct RecordingColumn : UnderstoodColumn {
    std::vector<double> values{};

    bool is(CsvColumn::Kind kind) const { return meaning && meaning->kind == kind; }
    bool is_gyro() const { return meaning && meaning->is_gyro(); }
    bool is_accelerometer() const { return is(CsvColumn::Kind::force); }
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
// Stamps whose unit no name tells are of the one that makes sense (stamp_unit.hpp). What was taken for what
// is said in a warning.
//
// Errors: malformed, invalid_argument (what the columns lack and which option gives it).
Result<Recording> recording_of(std::vector<RecordingColumn> columns, std::string name,
                               const RecordingReadOptions& options);

// What each of them is, before any number is read.
Result<std::vector<UnderstoodColumn>> understand_columns(std::span<const std::string> headers,
                                                         const RecordingReadOptions& options,
                                                         std::size_t user_named);

struct NumberColumn {
    std::string header;
    std::vector<double> values;
};

// Of columns that are all read: understood, in means where rows are means, with no number beyond any gyro.
// `options.choice.columns` by position are the names of the first ones.
Result<Recording> recording_of_numbers(std::vector<NumberColumn> columns, std::string name,
                                       const RecordingReadOptions& options);

// Beyond any gyro in any unit; squares of squares of it are still numbers.
inline constexpr double rate_most = 1e15;

}  // namespace gyrolog
