#include "analysis/noise/sensor_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

namespace gyrolog {
namespace {

bool is_missing(const Column& column, std::size_t row) {
    const auto* reals = std::get_if<std::vector<double>>(&column.data);
    return reals != nullptr && std::isnan((*reals)[row]);
}

}  // namespace

bool is_of(SensorKind sensor, const Column& column) {
    if (column.name.size() < 2) { return false; }
    if (sensor == SensorKind::gyro) { return column.name[0] == 'g'; }
    return column.name[0] == 'a' && column.name[1] >= 'x' && column.name[1] <= 'z';
}

std::optional<Recording> rows_with_accelerometer(const Recording& recording) {
    std::vector<const Column*> columns;
    for (const Column& column : recording.columns) {
        if (is_of(SensorKind::accelerometer, column) && !column.is_counts()) { columns.push_back(&column); }
    }
    const auto is_complete = [&](std::size_t row) {
        return std::ranges::none_of(columns, [&](const Column* c) { return is_missing(*c, row); });
    };
    std::size_t row = 0;
    while (row < recording.rows() && is_complete(row)) { ++row; }
    if (row == recording.rows()) { return std::nullopt; }
    return rows_of(recording, segments_where(recording.segments, is_complete));
}

}  // namespace gyrolog
