// Recordings as a table: a row for each recording and axis, the same cells as CSV and as SQLite.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "analysis/noise/sensor_unit.hpp"
#include "host/base/result.hpp"
#include "host/fleet/fleet_line.hpp"
#include "host/fleet/unit_population.hpp"

namespace gyrolog {

enum class CellKind { text, whole, real };
using Cell = std::variant<std::monostate, std::string, std::int64_t, double>;  // the first: not known

struct TableColumn {
    const char* name;
    CellKind kind;
};

// Each row has a cell for each column, of the column's kind or empty.
struct FleetTable {
    std::vector<TableColumn> columns;
    std::vector<std::vector<Cell>> rows;
};

// A recording without an axis of these sensors, as one that could not be read, is a row with an empty axis.
//
//   file, board, started, sensor, axis, unit     unit: of bias and B; N has unit/sqrt(Hz), K unit*sqrt(Hz), Q
//                                                unit*s, R unit/s
//   rate_hz, duration_s, samples, missing, temperature_C, end
//   bias, bias_sd, and of each of Q N B K R      Q, Q_sd, Q_upper, ...: value and standard deviation where it
//   is
//                                                identified, else the upper limit
//   verdict, causes                              "temp_lag=0.62;tone=0.11": those of this axis, with their
//   shares gap_before, gap_named, gap_after comparison                                   of `compare`, in
//   words outlier                                      "N=+4.2;rate_hz=-5.0": what stands out, with its
//   robust z exit, error, version, seed, seconds
FleetTable fleet_table(std::span<const FleetLine> recordings, std::span<const OutlyingParameter> outliers,
                       Sensors sensors);

// RFC 4180: a comma between cells, quotation marks where one is needed; an empty cell is not known. Numbers
// with as few digits as read back the same.
std::string as_csv(const FleetTable& table);

}  // namespace gyrolog
