#include "analysis/denoise/array_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace gyrolog {
namespace {

constexpr double rate_tolerance = 0.01;

// The number in "gx12"; 0 for "gx"; nothing for a column that is no gyro of this axis.
std::optional<unsigned long> unit_number(const std::string& column, char axis) {
    if (column.size() < 2 || column[0] != 'g' || column[1] != axis) { return std::nullopt; }
    const std::string digits = column.substr(2);
    if (digits.empty()) { return 0; }
    constexpr std::size_t digits_most = 6;
    if (digits.size() > digits_most || digits.find_first_not_of("0123456789") != std::string::npos) {
        return std::nullopt;
    }
    return std::stoul(digits);
}

// The row at a grid index.
class RowFinder {
public:
    explicit RowFinder(const Recording& recording) : segments_(recording.segments) {}

    std::optional<std::size_t> row_at(std::int64_t index) {
        while (at_ < segments_.size() && index >= end_of(segments_[at_])) { ++at_; }
        if (at_ == segments_.size() || index < segments_[at_].first_index) { return std::nullopt; }
        return segments_[at_].first + static_cast<std::size_t>(index - segments_[at_].first_index);
    }

private:
    static std::int64_t end_of(const Segment& segment) {
        return segment.first_index + static_cast<std::int64_t>(segment.count);
    }

    std::span<const Segment> segments_;
    std::size_t at_ = 0;  // indices only rise
};

// Which row of a member belongs to each row of the first one.
struct Matched {
    std::vector<std::optional<std::size_t>> rows;
    std::size_t found = 0;
    std::size_t slips = 0;  // neighbours in the one that are none in the other
};

Matched match(const ArrayMember& base, const ArrayMember& member) {
    Matched matched;
    matched.rows.reserve(base.recording->rows());
    RowFinder finder(*member.recording);
    for (const Segment& segment : base.recording->segments) {
        std::optional<std::int64_t> before;
        for (std::size_t i = 0; i < segment.count; ++i) {
            const double index = static_cast<double>(segment.first_index) + static_cast<double>(i);
            const double t_s = base.start_s + index / base.recording->rate_hz;
            const auto nearest = static_cast<std::int64_t>(
                std::floor((t_s - member.start_s) * member.recording->rate_hz + 0.5));
            if (before && nearest != *before + 1) { ++matched.slips; }
            before = nearest;
            matched.rows.push_back(finder.row_at(nearest));
            if (matched.rows.back()) { ++matched.found; }
        }
    }
    return matched;
}

Column matched_column(const Column& column, const Matched& matched) {
    std::vector<double> values;
    values.reserve(matched.rows.size());
    for (const std::optional<std::size_t>& row : matched.rows) {
        values.push_back(row ? column.value(*row) : std::numeric_limits<double>::quiet_NaN());
    }
    const std::string source = column.source_unit == "rad_s" ? "rad_s" : "";
    return {column.name, column.unit, std::move(values), 1.0, 0.0, source};
}

std::string number(double value) {
    std::ostringstream text;
    text << std::setprecision(7) << value;
    return text.str();
}

std::string why_not(const ArrayMember& base, const ArrayMember& member) {
    const double ratio = member.recording->rate_hz / base.recording->rate_hz;
    if (!(std::abs(ratio - 1.0) <= rate_tolerance)) {
        return "'" + member.recording->name + "' has a rate of " + number(member.recording->rate_hz) +
               " Hz, '" + base.recording->name + "' of " + number(base.recording->rate_hz) +
               " Hz; units of an array share their rate";
    }
    return "";
}

void take_gyros(Recording& joined, std::map<char, unsigned>& numbers, const Recording& from,
                const Matched* matched) {
    for (const ArrayAxis& axis : array_axes(from)) {
        for (const Column* unit : axis.units) {
            Column column = matched == nullptr ? *unit : matched_column(*unit, *matched);
            column.name = "g" + axis.name + std::to_string(++numbers[axis.name.front()]);
            joined.columns.push_back(std::move(column));
        }
    }
}

}  // namespace

std::vector<ArrayAxis> array_axes(const Recording& recording) {
    std::vector<ArrayAxis> axes;
    for (const char letter : {'x', 'y', 'z'}) {
        std::vector<std::pair<unsigned long, const Column*>> found;
        for (const Column& column : recording.columns) {
            if (const auto unit = unit_number(column.name, letter)) { found.emplace_back(*unit, &column); }
        }
        if (found.empty()) { continue; }
        std::ranges::sort(found, {}, [](const auto& unit) { return unit.first; });
        ArrayAxis axis{std::string(1, letter), {}, {}};
        for (const auto& [unit, column] : found) {
            axis.units.push_back(column);
            axis.unit_names.push_back(unit == 0 ? "" : std::to_string(unit));
        }
        axes.push_back(std::move(axis));
    }
    return axes;
}

JoinedArray join_recordings(std::span<const ArrayMember> members) {
    JoinedArray joined;
    const ArrayMember& base = members.front();
    Recording& array = joined.recording;
    array = *base.recording;
    std::erase_if(array.columns, [](const Column& column) { return column.name.starts_with('g'); });
    std::vector<Column> others = std::move(array.columns);
    array.columns.clear();
    std::map<char, unsigned> numbers;
    take_gyros(array, numbers, *base.recording, nullptr);
    for (const ArrayMember& member : members.subspan(1)) {
        joined.failure = why_not(base, member);
        if (!joined.failure.empty()) { return joined; }
        const Matched matched = match(base, member);
        if (matched.found == 0) {
            joined.failure =
                "'" + member.recording->name + "' and '" + base.recording->name + "' have no time in common";
            return joined;
        }
        const std::size_t missing = matched.rows.size() - matched.found;
        if (missing > 0) {
            array.warnings.push_back("'" + member.recording->name + "': no sample at " +
                                     std::to_string(missing) + " of " + std::to_string(matched.rows.size()) +
                                     " instants");
        }
        if (matched.slips > 0) {
            array.warnings.push_back("'" + member.recording->name +
                                     "': samples left out or taken twice for the difference of the clocks: " +
                                     std::to_string(matched.slips));
        }
        take_gyros(array, numbers, *member.recording, &matched);
    }
    std::ranges::move(others, std::back_inserter(array.columns));
    return joined;
}

std::vector<Segment> segments_known(std::span<const Column* const> columns,
                                    std::span<const Segment> segments) {
    return segments_where(segments, [&](std::size_t row) {
        return std::ranges::all_of(columns,
                                   [row](const Column* column) { return std::isfinite(column->value(row)); });
    });
}

Recording rows_of(const Recording& recording, std::span<const Column* const> columns,
                  std::span<const Segment> segments) {
    Recording part;
    part.name = recording.name;
    part.rate_hz = recording.rate_hz;
    part.rate_sd_hz = recording.rate_sd_hz;
    part.stamps = recording.stamps;
    for (const Column* column : columns) { part.columns.push_back(*column); }
    return rows_of(part, segments);
}

}  // namespace gyrolog
