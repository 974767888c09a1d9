// A recording as the analysis sees it: columns of numbers on a uniform grid of sampling instants, with holes
// where samples are missing. Where it came from (capture, text, simulation) is no longer visible.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace gyrolog {

// One quantity. The data stay as the source had them, sensor counts as integers and real numbers in the
// source's own unit, so that nothing is rounded on the way in; value() = data * scale + offset is in SI.
struct Column {
    std::string name;  // the quantity and its axis, without a unit: "gx", "gx2", "ax", "temp", "ref_x"
    std::string unit;  // of value(): "rad/s", "m/s^2", "degC"; "lsb" where the scale of counts is not known
    std::variant<std::vector<std::int16_t>, std::vector<double>> data;
    double scale = 1.0;   // `unit` per number in data
    double offset = 0.0;  // value at 0; only a temperature has one
    std::string
        source_unit{};  // of data, as a text column's name ends: "dps", "rad_s", "lsb", "g"; may be empty
    double bandwidth_hz =
        0.0;  // -3 dB of the low-pass filter that the samples came through; 0: not known, or none

    std::size_t size() const;
    bool is_counts() const { return data.index() == 0; }
    double value(std::size_t i) const;
    std::vector<double> values() const;
};

// Rows first ... first + count - 1 follow each other without a hole; the first of them is sampling instant
// `first_index` of the grid.
struct Segment {
    std::size_t first = 0;
    std::size_t count = 0;
    std::int64_t first_index = 0;
};

enum class StampKind {
    none,      // no time stamps came with the data: the rate was given
    sampling,  // stamps mark the sampling instants: dropouts can be read from them
    arrival,   // stamps mark when the data arrived (bursts): good for the mean rate only
};

// The cause of a pause that somebody wanted: its instants are not there, and nobody misses them.
inline constexpr std::string_view stopped_cause = "stopped";

struct Dropout {
    double at_s = 0.0;         // from the recording's first sample
    std::int64_t samples = 0;  // missing
    std::string
        cause;  // "sensor_fifo_overflow", "bus_error", "ring_overflow", "link", "time_stamps", "empty_fields"
};

// Of a recording's dropouts, those that somebody wanted.
struct Stops {
    std::size_t events = 0;
    std::int64_t instants = 0;
    double s = 0.0;
};

// Segments are in order and do not overlap on the grid; every row belongs to exactly one.
struct Recording {
    std::string name;
    double rate_hz = 0.0;                   // of rows; estimated from the stamps, or given
    std::size_t samples_per_row = 1;        // that each row is the mean of
    std::size_t reference_gyros = 0;        // of an array, that ref_x ... are a mean of; 0: none
    std::optional<double> nominal_rate_hz;  // what the device or the user said
    std::optional<double> rate_sd_hz;       // one sigma of the estimate
    std::optional<double> stamp_jitter_s;   // one sigma of the stamps about the fitted grid
    StampKind stamps = StampKind::none;
    std::vector<double> t_s;      // stamps as they came, one a row; empty with StampKind::none, and where
                                  // the segments hold all that the stamps said (a capture)
    std::vector<Column> columns;  // gyro first; its values are finite, others may hold NaN for "not known"
    std::vector<Segment> segments;
    std::vector<Dropout> dropouts;
    std::vector<std::string>
        warnings;  // for the user: what was odd about the data and what was done about it

    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
    const Column* find(std::string_view column_name) const;
    // Of the grid, also those of its stops.
    std::int64_t missing_samples() const;
    Stops stops() const;
    // From the first sampling instant to the end of the last one: (last index - first index + 1) / rate.
    double duration_s() const;
};

// What tells the motion from outside: ref_x, ref_qw, ...
bool is_reference(const Column& column);
bool has_reference(const Recording& recording);

// Each `samples`, at least one, of the grid in one row: their mean, of what is known of it. Where one of them
// is missing the row is; causes of dropouts are as they were. No stamps are kept.
Recording means_of(const Recording& recording, std::size_t samples);

// Parts of the segments whose rows are wanted, on the grid as it was.
std::vector<Segment> segments_where(std::span<const Segment> segments,
                                    const std::function<bool(std::size_t row)>& is_wanted);

// The rows of these segments, which lie within the recording's. The others are missing without being
// dropouts: stamps and causes stay as they were.
Recording rows_of(const Recording& recording, std::span<const Segment> segments);

// The recording as if it had ended after `rows`, at least one; whole if it has no more.
Recording first_rows(Recording recording, std::size_t rows);

}  // namespace gyrolog
