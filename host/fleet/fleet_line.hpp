// One line of what `analyze`, `check`, `compare` and `diagnose` write with --jsonl.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

// Of a coefficient that is not identified only `upper` is known.
struct FleetNumber {
    std::optional<double> value;
    std::optional<double> sd;
    std::optional<double> upper;
};

inline constexpr std::array fleet_coefficients{"Q", "N", "B", "K", "R"};

// Numbers are in `unit` and its products with s and Hz, as the line has them.
struct FleetAxis {
    std::string sensor;  // "gyro", "accelerometer"
    std::string axis;    // "x", or "x2" of an array
    std::string unit;    // "dps", "rad/s", "g", "m/s^2", "lsb"
    FleetNumber bias;    // of an accelerometer there is none: gravity is in its mean
    std::array<FleetNumber, fleet_coefficients.size()> coefficients;
    std::string comparison;  // the outcome in words
};

struct FleetCause {
    std::string effect;
    std::vector<std::string> axes;  // empty: all
    std::optional<double> share;
};

// What a line does not say is empty.
struct FleetLine {
    std::string file;
    std::string command;  // "analyze", "check", "compare", "diagnose"; of an error that does not say: ""
    std::string board;
    std::string started;
    std::optional<double> rate_hz;
    std::optional<double> duration_s;
    std::optional<std::uint64_t> samples;
    std::optional<std::uint64_t> missing;
    std::optional<double> temperature_C;
    std::string end;  // of a capture: "clean", "torn_tail", "damaged"
    std::vector<FleetAxis> axes;
    std::string verdict;
    std::vector<FleetCause> causes;
    std::optional<double> gap_before;
    std::optional<double> gap_named;
    std::optional<double> gap_after;
    std::optional<int> exit;
    std::string error;
    std::string version;
    std::optional<std::uint64_t> seed;
    std::optional<double> seconds;
};

// Errors `malformed`: no JSON object within the limits (input_limits.hpp), neither a known schema nor an
// error, without the file's name, or a key of the wrong type; with the column or the key.
Result<FleetLine> parse_fleet_line(std::string_view text);

// All lines of a file; empty ones are passed over. Plain, or compressed as TextReader reads it. Errors name
// the file and the number of the line.
Result<std::vector<FleetLine>> read_fleet_lines(const std::string& path);

// One name a line, without blanks around it.
Result<std::vector<std::string>> read_name_list(const std::string& path);

}  // namespace gyrolog
