// One file's columns, by their names and by what the user says of them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"
#include "host/formats/csv_column.hpp"

namespace gyrolog {

// What the user says of columns whose names do not say it. All may be empty.
struct ColumnChoice {
    // "t,gx,gy,gz": names by position, of a file without any or in place of its own; "_" or "-" leaves a
    // column out. Or "NAME=gx_dps,OTHER=_": for some of the file's names.
    std::string columns{};
    std::string gyro_unit{};           // of gyro columns without one: deg/s, rad/s, deg/h, lsb
    std::string accelerometer_unit{};  // of those of an accelerometer: g, m/s^2, lsb
};

struct ColumnNames {
    std::vector<std::string> by_position;
    std::map<std::string, std::string, std::less<>> by_name;
};

// Errors: invalid_argument.
Result<ColumnNames> parse_column_names(const std::string& columns);
// The error of a ColumnChoice that makes no sense, whatever the file.
Status check_column_choice(const ColumnChoice& choice);

// Of one file's columns, what each of them is.
struct UnderstoodColumn {
    std::string header;
    std::optional<CsvColumn> meaning;  // nothing: ignored
    bool is_left_out = false;          // as the user said
    bool lacks_unit = false;           // an accelerometer's, which is ignored for that
    bool any_stamp_unit = false;       // taken for t_s until its numbers decide (stamp_unit.hpp)
    std::string taken_for{};           // the canonical name; empty: the file has that itself
};

struct WantedColumns {
    bool needs_gyro = true;  // else an accelerometer alone will do
    bool with_accelerometer = true;
    bool rate_is_given = false;
};

// Each column is what its name says: by the canonical names of recording.md, or else by those of any dialect,
// or by canonical ones in capitals. Where one quantity has both, the canonical name wins and the other is
// ignored; of several times one is taken. In a file with a canonical gyro, a dialect's gyro without a unit is
// ignored, and so is its time where a rate is given.
//
// `user_named`: so many of the first names are the user's own, and what is beyond is ignored. Errors:
// malformed (nothing is a sensor; one quantity twice), invalid_argument (a unit is missing; a name of the
// user's is none), which name the columns and what to do.
Result<std::vector<UnderstoodColumn>> understand_columns(std::span<const std::string> headers,
                                                         const ColumnChoice& choice,
                                                         const WantedColumns& wanted, std::size_t user_named);

// "a, b, c and 12 more": printable, no more of them than help.
std::string some_names(std::span<const std::string> names);

}  // namespace gyrolog
