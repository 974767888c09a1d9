#include "analysis/recording/recording.hpp"

#include <algorithm>

namespace gyrolog {

std::size_t Column::size() const {
    return std::visit([](const auto& values) { return values.size(); }, data);
}

double Column::value(std::size_t i) const {
    return std::visit([&](const auto& values) { return static_cast<double>(values[i]) * scale + offset; },
                      data);
}

std::vector<double> Column::values() const {
    std::vector<double> all(size());
    for (std::size_t i = 0; i < all.size(); ++i) { all[i] = value(i); }
    return all;
}

const Column* Recording::find(std::string_view column_name) const {
    const auto found =
        std::ranges::find_if(columns, [&](const Column& column) { return column.name == column_name; });
    return found == columns.end() ? nullptr : &*found;
}

std::int64_t Recording::missing_samples() const {
    if (segments.empty()) { return 0; }
    const Segment& last = segments.back();
    return last.first_index + static_cast<std::int64_t>(last.count) - segments.front().first_index -
           static_cast<std::int64_t>(rows());
}

double Recording::duration_s() const {
    if (segments.empty() || rate_hz <= 0.0) { return 0.0; }
    const Segment& last = segments.back();
    return static_cast<double>(last.first_index + static_cast<std::int64_t>(last.count) -
                               segments.front().first_index) /
           rate_hz;
}

Recording first_rows(Recording recording, std::size_t rows) {
    if (rows >= recording.rows()) { return recording; }
    for (Column& column : recording.columns) {
        std::visit(
            [&](auto& values) {
                values.resize(rows);
                values.shrink_to_fit();
            },
            column.data);
    }
    if (!recording.t_s.empty()) {
        recording.t_s.resize(rows);
        recording.t_s.shrink_to_fit();
    }
    std::erase_if(recording.segments, [&](const Segment& segment) { return segment.first >= rows; });
    Segment& last = recording.segments.back();
    last.count = std::min(last.count, rows - last.first);
    const double end_s = recording.duration_s();
    std::erase_if(recording.dropouts, [&](const Dropout& dropout) { return dropout.at_s >= end_s; });
    return recording;
}

}  // namespace gyrolog
