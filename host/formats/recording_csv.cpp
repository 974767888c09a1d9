#include "host/formats/recording_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/grid.hpp"
#include "host/formats/csv_column.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

constexpr double standard_gravity_m_s2 = 9.80665;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

Error malformed(std::string message) { return {ErrorCode::malformed, std::move(message)}; }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) { text.remove_prefix(1); }
    while (!text.empty() && is_blank(text.back())) { text.remove_suffix(1); }
    return text;
}

struct InputColumn {
    std::string header;
    std::optional<CsvColumn> meaning;  // nothing: ignored
    std::vector<double> values;

    bool is(CsvColumn::Kind kind) const { return meaning && meaning->kind == kind; }
    bool is_gyro() const { return meaning && meaning->is_gyro(); }
};

// Takes text in pieces that may end anywhere, and keeps the numbers.
class Table {
public:
    // With `needs_stamps` an empty field of t_s is an error.
    explicit Table(bool needs_stamps) : needs_stamps_(needs_stamps) {}

    Status feed(std::string_view piece) {
        while (!piece.empty()) {
            const std::size_t end = piece.find('\n');
            if (end == std::string_view::npos) {
                rest_.append(piece);
                return {};
            }
            if (rest_.empty()) {
                GYROLOG_CHECK(line(piece.substr(0, end)));
            } else {
                rest_.append(piece.substr(0, end));
                GYROLOG_CHECK(line(rest_));
                rest_.clear();
            }
            piece.remove_prefix(end + 1);
        }
        return {};
    }

    Status finish() {
        if (!rest_.empty()) { GYROLOG_CHECK(line(rest_)); }
        if (columns_.empty()) {
            return malformed("empty: line 1 must name the columns, such as t_s,gx_dps,gy_dps,gz_dps");
        }
        return {};
    }

    std::vector<InputColumn>& columns() { return columns_; }

private:
    Status line(std::string_view text) {
        ++number_;
        if (!text.empty() && text.back() == '\r') { text.remove_suffix(1); }
        if (number_ == 1) { return header(text); }
        // In a table of one column an empty line is an empty field, that is a missing sample.
        if (text.empty() && columns_.size() > 1) { return {}; }
        const char* at = text.data();
        const char* const end = at + text.size();
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            if (c > 0) {
                if (at == end) { return wrong_count(text); }
                ++at;  // the comma
            }
            GYROLOG_CHECK(field(columns_[c], at, end));
        }
        return at == end ? Status() : wrong_count(text);
    }

    // Reads one field and leaves `at` on the comma after it, or the end of the line.
    Status field(InputColumn& column, const char*& at, const char* end) {
        if (!column.meaning) {
            at = std::find(at, end, ',');
            return {};
        }
        const char* const begin = at;
        while (at != end && is_blank(*at)) { ++at; }
        double value = missing;
        if (at != end && *at != ',') {
            if (*at == '+' && end - at > 1 && at[1] != '-') { ++at; }
            const auto [stop, problem] = std::from_chars(at, end, value);
            at = stop;
            while (at != end && is_blank(*at)) { ++at; }
            if (problem != std::errc() || (at != end && *at != ',') || std::isinf(value)) {
                return malformed(place(column) + "'" + std::string(begin, std::find(begin, end, ',')) +
                                 "' is no number; leave the field empty where a sample is missing");
            }
        }
        if (needs_stamps_ && std::isnan(value) && column.is(CsvColumn::Kind::time_stamp)) {
            return malformed(place(column) + "no time stamp; give the sampling rate with --rate");
        }
        column.values.push_back(value);
        return {};
    }

    Status header(std::string_view text) {
        if (text.starts_with("\xEF\xBB\xBF")) { text.remove_prefix(3); }
        while (true) {
            const std::size_t comma = text.find(',');
            const std::string name(trimmed(text.substr(0, comma)));
            for (const InputColumn& column : columns_) {
                if (column.header == name) {
                    return malformed("line 1: column '" + name + "' appears twice");
                }
            }
            columns_.push_back({name, csv_column(name), {}});
            if (comma == std::string_view::npos) { break; }
            text.remove_prefix(comma + 1);
        }
        const bool any_gyro = std::ranges::any_of(columns_, &InputColumn::is_gyro);
        if (!any_gyro) {
            return malformed(
                "line 1: no gyro column; it must name the columns with their units, such as "
                "t_s,gx_dps,gy_dps,gz_dps (or _rad_s, _lsb, _deg, _rad)");
        }
        return {};
    }

    Status wrong_count(std::string_view text) const {
        const auto fields = std::count(text.begin(), text.end(), ',') + 1;
        return malformed("line " + std::to_string(number_) + ": " + std::to_string(fields) +
                         " fields where line 1 names " + std::to_string(columns_.size()));
    }

    std::string place(const InputColumn& column) const {
        return "line " + std::to_string(number_) + ", column '" + column.header + "': ";
    }

    bool needs_stamps_;
    std::vector<InputColumn> columns_;
    std::string rest_;
    std::size_t number_ = 0;
};

void keep_rows(std::vector<double>& values, const std::vector<bool>& present) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < present.size(); ++i) {
        if (present[i]) { values[kept++] = values[i]; }
    }
    values.resize(kept);
}

// The columns of one table on one grid.
struct Gridded {
    std::vector<double> t_s;
    std::vector<InputColumn> columns;  // known ones, without t_s
    Grid grid;

    void keep(const std::vector<bool>& present) {
        if (std::ranges::all_of(present, [](bool stays) { return stays; })) { return; }
        punch_holes(grid, present);
        for (InputColumn& column : columns) { keep_rows(column.values, present); }
        if (!t_s.empty()) { keep_rows(t_s, present); }
    }
};

Result<Gridded> on_grid(Table& table, const CsvReadOptions& options) {
    Gridded gridded;
    std::size_t rows = 0;
    for (InputColumn& column : table.columns()) {
        if (!column.meaning) { continue; }
        rows = column.values.size();
        if (column.is(CsvColumn::Kind::time_stamp)) {
            gridded.t_s = std::move(column.values);
        } else {
            gridded.columns.push_back(std::move(column));
        }
    }
    if (rows == 0) { return malformed("no samples after the header line"); }
    if (options.rate_hz) {
        gridded.t_s.clear();
        gridded.grid = grid_from_rate(rows, *options.rate_hz);
        return gridded;
    }
    if (gridded.t_s.empty()) {
        return Error{ErrorCode::invalid_argument, "no column t_s: give the sampling rate with --rate"};
    }
    gridded.grid = grid_from_stamps(gridded.t_s);
    if (!gridded.grid.failure.empty()) { return malformed(gridded.grid.failure); }
    return gridded;
}

void drop_missing_samples(Gridded& gridded) {
    std::vector<bool> present(gridded.columns.front().values.size(), true);
    for (const InputColumn& column : gridded.columns) {
        if (!column.is_gyro()) { continue; }
        for (std::size_t i = 0; i < present.size(); ++i) {
            if (std::isnan(column.values[i])) { present[i] = false; }
        }
    }
    gridded.keep(present);
}

// An angle, or an increment after a hole, gives no rate at the first sample of a segment.
void differentiate_angles(Gridded& gridded) {
    bool any_angle = false;
    bool any_increment = false;
    for (InputColumn& column : gridded.columns) {
        if (column.is(CsvColumn::Kind::angle)) {
            any_angle = true;
            for (std::size_t i = column.values.size(); i-- > 1;) {
                column.values[i] = (column.values[i] - column.values[i - 1]) * gridded.grid.rate_hz;
            }
        } else if (column.is(CsvColumn::Kind::angle_increment)) {
            any_increment = true;
            for (double& value : column.values) { value *= gridded.grid.rate_hz; }
        }
    }
    if (!any_angle && !any_increment) { return; }
    std::vector<bool> present(gridded.columns.front().values.size(), true);
    for (std::size_t s = any_angle ? 0 : 1; s < gridded.grid.segments.size(); ++s) {
        present[gridded.grid.segments[s].first] = false;
    }
    gridded.keep(present);
}

bool fits_counts(const std::vector<double>& values) {
    return std::ranges::all_of(values,
                               [](double x) { return x >= -32768.0 && x <= 32767.0 && x == std::floor(x); });
}

Result<Column> column_of(InputColumn& input, const CsvReadOptions& options) {
    const CsvColumn& meaning = *input.meaning;
    Column column{meaning.name,  meaning.unit, std::move(input.values),
                  meaning.scale, 0.0,          meaning.source_unit};
    if (!meaning.is_counts()) { return column; }
    if (meaning.is_gyro() && options.lsb_dps) {
        column.scale = *options.lsb_dps * rad_per_deg;
    } else if (!meaning.is_gyro() && options.lsb_g) {
        column.scale = *options.lsb_g * standard_gravity_m_s2;
    } else if (!meaning.is_gyro() || options.allow_unscaled_counts) {
        column.unit = "lsb";
    } else {
        return Error{ErrorCode::invalid_argument,
                     "column '" + input.header +
                         "' is in counts: give their scale with --lsb-dps (degrees per second per count)"};
    }
    const auto& reals = std::get<std::vector<double>>(column.data);
    if (fits_counts(reals)) {
        std::vector<std::int16_t> counts(reals.size());
        std::ranges::transform(reals, counts.begin(), [](double x) { return static_cast<std::int16_t>(x); });
        column.data = std::move(counts);
    }
    return column;
}

std::string unknown_columns(std::span<const InputColumn> columns) {
    std::string names;
    for (const InputColumn& column : columns) {
        if (!column.meaning) { names += (names.empty() ? "" : ", ") + column.header; }
    }
    return names.empty() ? names : "ignored columns of unknown name: " + names;
}

Result<Recording> recording_of(Table& table, std::string name, const CsvReadOptions& options) {
    Recording recording;
    recording.name = std::move(name);
    if (std::string warning = unknown_columns(table.columns()); !warning.empty()) {
        recording.warnings.push_back(std::move(warning));
    }
    GYROLOG_TRY(Gridded gridded, on_grid(table, options));
    drop_missing_samples(gridded);
    differentiate_angles(gridded);
    if (gridded.columns.front().values.empty()) { return malformed("no complete sample"); }
    std::stable_partition(gridded.columns.begin(), gridded.columns.end(),
                          [](const InputColumn& column) { return column.is_gyro(); });
    for (InputColumn& input : gridded.columns) {
        GYROLOG_TRY(Column column, column_of(input, options));
        recording.columns.push_back(std::move(column));
    }
    recording.rate_hz = gridded.grid.rate_hz;
    recording.rate_sd_hz = gridded.grid.rate_sd_hz;
    recording.stamp_jitter_s = gridded.grid.stamp_jitter_s;
    recording.stamps = gridded.grid.stamps;
    recording.t_s = std::move(gridded.t_s);
    recording.segments = std::move(gridded.grid.segments);
    recording.dropouts = std::move(gridded.grid.dropouts);
    recording.warnings.insert(recording.warnings.end(), gridded.grid.warnings.begin(),
                              gridded.grid.warnings.end());
    return recording;
}

Status feed_file(Table& table, const std::string& path) {
    GYROLOG_TRY(TextReader reader, TextReader::open(path));
    while (true) {
        GYROLOG_TRY(const std::string_view piece, reader.read());
        if (piece.empty()) { return table.finish(); }
        GYROLOG_CHECK(table.feed(piece));
    }
}

Result<Recording> read_file(const std::string& path, const CsvReadOptions& options) {
    Table table(!options.rate_hz);
    GYROLOG_CHECK(feed_file(table, path));
    return recording_of(table, path.substr(path.find_last_of('/') + 1), options);
}

}  // namespace

Result<Recording> read_recording_csv(const std::string& path, const CsvReadOptions& options) {
    Result<Recording> recording = read_file(path, options);
    if (!recording.ok()) { return in_context("read '" + path + "'", std::move(recording).error()); }
    return recording;
}

Result<Recording> parse_recording_csv(std::string_view text, std::string name,
                                      const CsvReadOptions& options) {
    Table table(!options.rate_hz);
    GYROLOG_CHECK(table.feed(text));
    GYROLOG_CHECK(table.finish());
    return recording_of(table, std::move(name), options);
}

}  // namespace gyrolog
