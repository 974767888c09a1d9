#include "analysis/recording/recording.hpp"

#include <algorithm>
#include <cmath>

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

bool is_reference(const Column& column) { return column.name.starts_with("ref_"); }

bool has_reference(const Recording& recording) {
    return std::ranges::any_of(recording.columns, is_reference);
}

Stops Recording::stops() const {
    Stops stops;
    for (const Dropout& hole : dropouts) {
        if (hole.cause != stopped_cause) { continue; }
        ++stops.events;
        stops.instants += hole.samples;
    }
    const double instants_per_s = rate_hz * static_cast<double>(samples_per_row);
    if (instants_per_s > 0.0) { stops.s = static_cast<double>(stops.instants) / instants_per_s; }
    return stops;
}

double Recording::duration_s() const {
    if (segments.empty() || rate_hz <= 0.0) { return 0.0; }
    const Segment& last = segments.back();
    return static_cast<double>(last.first_index + static_cast<std::int64_t>(last.count) -
                               segments.front().first_index) /
           rate_hz;
}

namespace {

// Row by row of the means: the first of the rows it is made of, and its place on its own grid.
struct MeanRow {
    std::size_t first = 0;
    std::int64_t index = 0;
};

std::vector<MeanRow> mean_rows(const Recording& recording, std::int64_t samples) {
    std::vector<MeanRow> rows;
    const std::int64_t origin = recording.segments.empty() ? 0 : recording.segments.front().first_index;
    for (const Segment& segment : recording.segments) {
        const std::int64_t begin = segment.first_index - origin;
        const std::int64_t end = begin + static_cast<std::int64_t>(segment.count);
        for (std::int64_t index = (begin + samples - 1) / samples; (index + 1) * samples <= end; ++index) {
            rows.push_back({segment.first + static_cast<std::size_t>(index * samples - begin), index});
        }
    }
    return rows;
}

Column mean_column(const Column& column, const std::vector<MeanRow>& rows, std::size_t samples) {
    std::vector<double> means;
    means.reserve(rows.size());
    for (const MeanRow& row : rows) {
        double sum = 0.0;
        double known = 0.0;
        for (std::size_t i = row.first; i < row.first + samples; ++i) {
            const double value = column.value(i);
            if (std::isnan(value)) { continue; }
            sum += value;
            known += 1.0;
        }
        means.push_back(known > 0.0 ? sum / known : std::nan(""));
    }
    return {column.name, column.unit, std::move(means), 1.0, 0.0, "", column.bandwidth_hz};
}

}  // namespace

Recording means_of(const Recording& recording, std::size_t samples) {
    if (samples < 2) { return recording; }
    const auto number = static_cast<double>(samples);
    Recording means;
    means.name = recording.name;
    means.rate_hz = recording.rate_hz / number;
    means.samples_per_row = recording.samples_per_row * samples;
    means.reference_gyros = recording.reference_gyros;
    if (recording.nominal_rate_hz) { means.nominal_rate_hz = *recording.nominal_rate_hz / number; }
    if (recording.rate_sd_hz) { means.rate_sd_hz = *recording.rate_sd_hz / number; }
    means.dropouts = recording.dropouts;
    means.warnings = recording.warnings;
    const std::vector<MeanRow> rows = mean_rows(recording, static_cast<std::int64_t>(samples));
    for (const Column& column : recording.columns) {
        means.columns.push_back(mean_column(column, rows, samples));
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool follows = i > 0 && rows[i].index == rows[i - 1].index + 1;
        if (!follows) { means.segments.push_back({i, 0, rows[i].index}); }
        ++means.segments.back().count;
    }
    return means;
}

std::vector<Segment> segments_where(std::span<const Segment> segments,
                                    const std::function<bool(std::size_t row)>& is_wanted) {
    std::vector<Segment> wanted;
    for (const Segment& segment : segments) {
        bool follows = false;
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            const bool take = is_wanted(row);
            if (take && !follows) {
                wanted.push_back({row, 0, segment.first_index + static_cast<std::int64_t>(i)});
            }
            if (take) { ++wanted.back().count; }
            follows = take;
        }
    }
    return wanted;
}

Recording rows_of(const Recording& recording, std::span<const Segment> segments) {
    const auto cut = [&](auto& values) {
        auto to = values.begin();
        for (const Segment& segment : segments) {
            const auto from = values.begin() + static_cast<std::ptrdiff_t>(segment.first);
            to = std::copy(from, from + static_cast<std::ptrdiff_t>(segment.count), to);
        }
        values.erase(to, values.end());
    };
    Recording part = recording;
    for (Column& column : part.columns) { std::visit(cut, column.data); }
    if (!part.t_s.empty()) { cut(part.t_s); }
    part.segments.clear();
    std::size_t rows = 0;
    for (const Segment& segment : segments) {
        part.segments.push_back({rows, segment.count, segment.first_index});
        rows += segment.count;
    }
    return part;
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
