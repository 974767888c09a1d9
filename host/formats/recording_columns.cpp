#include "host/formats/recording_columns.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/grid.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "host/base/printable.hpp"
#include "host/formats/csv_table.hpp"
#include "host/formats/stamp_unit.hpp"

namespace gyrolog {
namespace {

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
    std::vector<double> stopped_s;
    std::vector<RecordingColumn> columns;  // known ones, without these two
    Grid grid;

    void keep(const std::vector<bool>& present) {
        if (std::ranges::all_of(present, [](bool stays) { return stays; })) { return; }
        punch_holes(grid, present);
        for (RecordingColumn& column : columns) { keep_rows(column.values, present); }
        if (!t_s.empty()) { keep_rows(t_s, present); }
        if (!stopped_s.empty()) { keep_rows(stopped_s, present); }
    }
};

// How long a period lasts is what was asked for; where samples are missing, stamps tell all the same.
void use_given_rate(Gridded& gridded, std::size_t rows, double rate_hz, double samples_per_row) {
    Grid& grid = gridded.grid;
    if (!grid.failure.empty()) {
        const std::string warning = "missing samples cannot be seen: " + grid.failure;
        gridded.t_s.clear();
        grid = grid_from_rate(rows, rate_hz / samples_per_row);
        grid.warnings.push_back(warning);
        return;
    }
    constexpr double same = 1e-3;
    const double stamped_hz = grid.rate_hz * samples_per_row;
    if (std::abs(rate_hz / stamped_hz - 1.0) > same) {
        grid.warnings.push_back(fmt::format(
            "the rate is taken as {:g} Hz, as given; the time stamps say {:.6g} Hz", rate_hz, stamped_hz));
    }
    grid.rate_hz = rate_hz / samples_per_row;
    grid.rate_sd_hz.reset();
}

std::vector<double> in_seconds(RecordingColumn&& stamps) {
    if (stamps.meaning->per_s != 1.0) {
        for (double& stamp : stamps.values) { stamp /= stamps.meaning->per_s; }
    }
    return std::move(stamps.values);
}

Result<Gridded> on_grid(std::vector<RecordingColumn> columns, const RecordingReadOptions& options) {
    Gridded gridded;
    std::size_t rows = 0;
    for (RecordingColumn& column : columns) {
        if (!column.meaning) { continue; }
        rows = column.values.size();
        if (column.is(CsvColumn::Kind::time_stamp)) {
            gridded.t_s = in_seconds(std::move(column));
        } else if (column.is(CsvColumn::Kind::stop)) {
            gridded.stopped_s = std::move(column.values);
        } else {
            gridded.columns.push_back(std::move(column));
        }
    }
    if (rows == 0) { return malformed("no samples after the header line"); }
    const auto samples_per_row = static_cast<double>(options.samples_per_row);
    if (options.rate_hz && gridded.t_s.empty()) {
        gridded.grid = grid_from_rate(rows, *options.rate_hz / samples_per_row);
        return gridded;
    }
    if (gridded.t_s.empty()) {
        return Error{ErrorCode::invalid_argument,
                     "no column t_s: give the sampling rate with --rate, or say which column "
                     "is the time with --columns NAME=t_s (or t_ms, t_us, t_ns)"};
    }
    const bool stamped = std::ranges::none_of(gridded.t_s, [](double t_s) { return std::isnan(t_s); });
    gridded.grid = stamped ? grid_from_stamps(gridded.t_s) : Grid{};
    if (!stamped) { gridded.grid.failure = "time stamps are missing"; }
    if (options.rate_hz) {
        use_given_rate(gridded, rows, *options.rate_hz, samples_per_row);
    } else if (!gridded.grid.failure.empty()) {
        return malformed(gridded.grid.failure);
    }
    return gridded;
}

void drop_missing_samples(Gridded& gridded) {
    std::vector<bool> present(gridded.columns.front().values.size(), true);
    const bool has_gyro = std::ranges::any_of(gridded.columns, &RecordingColumn::is_gyro);
    for (const RecordingColumn& column : gridded.columns) {
        if (has_gyro ? !column.is_gyro() : !column.is_accelerometer()) { continue; }
        for (std::size_t i = 0; i < present.size(); ++i) {
            if (std::isnan(column.values[i])) { present[i] = false; }
        }
    }
    gridded.keep(present);
}

// An angle, or an increment after a hole, gives no rate at the first sample of a segment.
void differentiate_angles(Gridded& gridded, std::size_t samples_per_row) {
    bool any_angle = false;
    bool any_increment = false;
    for (RecordingColumn& column : gridded.columns) {
        if (column.is(CsvColumn::Kind::angle)) {
            any_angle = true;
            for (std::size_t i = column.values.size(); i-- > 1;) {
                column.values[i] = (column.values[i] - column.values[i - 1]) * gridded.grid.rate_hz;
            }
        } else if (column.is(CsvColumn::Kind::angle_increment)) {
            any_increment = true;
            const double sample_rate_hz = gridded.grid.rate_hz * static_cast<double>(samples_per_row);
            for (double& value : column.values) { value *= sample_rate_hz; }
        }
    }
    if (!any_angle && !any_increment) { return; }
    std::vector<bool> present(gridded.columns.front().values.size(), true);
    for (std::size_t s = any_angle ? 0 : 1; s < gridded.grid.segments.size(); ++s) {
        present[gridded.grid.segments[s].first] = false;
    }
    gridded.keep(present);
}

// Of a hole, what the sample behind it says that the board was stopped for, the last part, is a stop; the
// rest is missing.
void tell_stops(Grid& grid, const std::vector<double>& stopped_s) {
    if (stopped_s.empty() || grid.dropouts.size() + 1 != grid.segments.size()) { return; }
    std::vector<Dropout> told;
    for (std::size_t hole = 0; hole < grid.dropouts.size(); ++hole) {
        Dropout& found = grid.dropouts[hole];
        const double stop_s = stopped_s[grid.segments[hole + 1].first];
        const double most = static_cast<double>(found.samples);
        const std::int64_t stopped = stop_s > 0.0 ? std::llround(std::min(stop_s * grid.rate_hz, most)) : 0;
        const std::int64_t missing = found.samples - stopped;
        const double stop_at_s = found.at_s + static_cast<double>(missing) / grid.rate_hz;
        if (missing > 0) { told.push_back({found.at_s, missing, std::move(found.cause)}); }
        if (stopped > 0) { told.push_back({stop_at_s, stopped, std::string(stopped_cause)}); }
    }
    grid.dropouts = std::move(told);
}

bool fits_counts(const std::vector<double>& values) {
    return std::ranges::all_of(values,
                               [](double x) { return x >= -32768.0 && x <= 32767.0 && x == std::floor(x); });
}

Result<Column> column_of(RecordingColumn& input, const RecordingReadOptions& options) {
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
                     "column " + in_quotes(input.header) +
                         " is in counts: give their scale with --lsb-dps (degrees per second per count)"};
    }
    const auto& reals = std::get<std::vector<double>>(column.data);
    if (fits_counts(reals)) {
        std::vector<std::int16_t> counts(reals.size());
        std::ranges::transform(reals, counts.begin(), [](double x) { return static_cast<std::int16_t>(x); });
        column.data = std::move(counts);
    }
    return column;
}

std::string unknown_columns(std::span<const RecordingColumn> columns) {
    std::vector<std::string> names;
    for (const RecordingColumn& column : columns) {
        if (!column.meaning && !column.is_left_out && !column.lacks_unit) { names.push_back(column.header); }
    }
    return names.empty() ? "" : "ignored columns of unknown name: " + some_names(names);
}

std::string columns_without_unit(std::span<const RecordingColumn> columns,
                                 const RecordingReadOptions& options) {
    std::vector<std::string> names;
    for (const RecordingColumn& column : columns) {
        if (column.lacks_unit && options.with_accelerometer) { names.push_back(column.header); }
    }
    return names.empty() ? ""
                         : "ignored columns without a unit, which --acc-unit gives: " + some_names(names);
}

// "gyr_x is taken for gx_rad_s, timestamp for t_ns"; empty where the names were canonical.
std::string taken_for(std::span<const RecordingColumn> columns) {
    constexpr std::size_t told_most = 10;
    std::string text;
    std::size_t taken = 0;
    for (const RecordingColumn& column : columns) {
        if (!column.meaning || column.taken_for.empty() || ++taken > told_most) { continue; }
        const char* verb = text.empty() ? "is taken " : "";
        text += fmt::format("{}{} {}for {}", text.empty() ? "" : ", ", printable(column.header), verb,
                            column.taken_for);
    }
    if (taken > told_most) { text += fmt::format(" and {} more", taken - told_most); }
    return text;
}

Error undecided(const RecordingColumn& column, const StampUnits& found) {
    std::string problem =
        fmt::format("step by {:.6g}, which is no sampling period in s, ms, us or ns", found.step);
    if (!found.units.empty()) {
        std::vector<std::string> rates;
        for (const StampUnit& unit : found.units) {
            rates.push_back(fmt::format("{:.4g} Hz in {}", unit.per_s / found.step, unit.name));
        }
        problem = fmt::format("may be {}", fmt::join(rates, " or "));
    }
    return invalid_argument(
        fmt::format("the time stamps of column {} {}: name it with --columns {}=t_s (or t_ms, "
                    "t_us, t_ns)",
                    in_quotes(column.header), problem, printable(column.header)));
}

// A given rate tells which of several units is meant. Where it does not, there are no stamps.
Status decide_stamp_unit(RecordingColumn& column, const RecordingReadOptions& options) {
    StampUnits found = plausible_stamp_units(column.values, static_cast<double>(options.samples_per_row));
    if (options.rate_hz && found.units.size() != 1) {
        constexpr double same = 0.2;
        std::erase_if(found.units, [&](const StampUnit& unit) {
            return std::abs(unit.per_s / found.step / *options.rate_hz - 1.0) > same;
        });
        if (found.units.empty()) {
            column.meaning.reset();
            return {};
        }
    }
    if (found.units.size() != 1) { return undecided(column, found); }
    column.taken_for = "t_" + std::string(found.units.front().name);
    column.meaning = csv_column(column.taken_for);
    return {};
}

// Where a file of numbers holds what a text may not.
Status check_numbers(const RecordingColumn& column, const RecordingReadOptions& options) {
    const bool needed = column.is(CsvColumn::Kind::time_stamp) && !options.rate_hz;
    const double most = column.is_gyro() ? rate_most : std::numeric_limits<double>::max();
    for (std::size_t row = 0; row < column.values.size(); ++row) {
        const double value = column.values[row];
        const char* problem = nullptr;
        if (std::isnan(value)) {
            if (needed) { problem = "no time stamp; give the sampling rate with --rate"; }
        } else if (!(std::abs(value) <= most)) {
            problem = "beyond what any sensor says";
        }
        if (problem != nullptr) {
            return malformed(fmt::format("row {}, column {}: {} is {}", row + 1, in_quotes(column.header),
                                         value, problem));
        }
    }
    return {};
}

// No more than is wanted of them, and each row the mean of so many.
void take_means(RecordingColumn& column, const RecordingReadOptions& options) {
    std::vector<double>& values = column.values;
    values.resize(std::min(values.size(), options.rows_most));
    if (options.samples_per_row < 2) { return; }
    const std::size_t rows = values.size() / options.samples_per_row;
    for (std::size_t row = 0; row < rows; ++row) {
        values[row] =
            mean_of_lines(std::span(values).subspan(row * options.samples_per_row, options.samples_per_row),
                          column.is_gyro());
    }
    values.resize(rows);
}

}  // namespace

Result<Recording> recording_of(std::vector<RecordingColumn> columns, std::string name,
                               const RecordingReadOptions& options) {
    for (RecordingColumn& column : columns) {
        if (column.any_stamp_unit && column.meaning) { GYROLOG_CHECK(decide_stamp_unit(column, options)); }
    }
    Recording recording;
    recording.name = std::move(name);
    for (std::string told :
         {taken_for(columns), unknown_columns(columns), columns_without_unit(columns, options)}) {
        if (!told.empty()) { recording.warnings.push_back(std::move(told)); }
    }
    GYROLOG_TRY(Gridded gridded, on_grid(std::move(columns), options));
    drop_missing_samples(gridded);
    differentiate_angles(gridded, options.samples_per_row);
    if (options.samples_per_row == 1) { tell_stops(gridded.grid, gridded.stopped_s); }
    if (gridded.columns.front().values.empty()) { return malformed("no complete sample"); }
    std::stable_partition(gridded.columns.begin(), gridded.columns.end(),
                          [](const RecordingColumn& column) { return column.is_gyro(); });
    for (RecordingColumn& input : gridded.columns) {
        GYROLOG_TRY(Column column, column_of(input, options));
        recording.columns.push_back(std::move(column));
    }
    recording.rate_hz = gridded.grid.rate_hz;
    recording.rate_sd_hz = gridded.grid.rate_sd_hz;
    recording.samples_per_row = options.samples_per_row;
    if (options.samples_per_row == 1) {
        recording.stamp_jitter_s = gridded.grid.stamp_jitter_s;
        recording.stamps = gridded.grid.stamps;
        recording.t_s = std::move(gridded.t_s);
    }
    recording.segments = std::move(gridded.grid.segments);
    recording.dropouts = std::move(gridded.grid.dropouts);
    recording.warnings.insert(recording.warnings.end(), gridded.grid.warnings.begin(),
                              gridded.grid.warnings.end());
    return recording;
}

Result<std::vector<UnderstoodColumn>> understand_columns(std::span<const std::string> headers,
                                                         const RecordingReadOptions& options,
                                                         std::size_t user_named) {
    return understand_columns(headers, options.choice,
                              {options.needs_gyro, options.with_accelerometer, options.rate_hz.has_value()},
                              user_named);
}

Result<Recording> recording_of_numbers(std::vector<NumberColumn> columns, std::string name,
                                       const RecordingReadOptions& options) {
    GYROLOG_TRY(ColumnNames names, parse_column_names(options.choice.columns));
    const std::size_t user_named = names.by_position.size();
    if (user_named > columns.size()) {
        return invalid_argument(fmt::format("--columns names {}, and there {} {}", user_named,
                                            columns.size() == 1 ? "is" : "are", columns.size()));
    }
    std::vector<std::string> headers;
    headers.reserve(columns.size());
    for (NumberColumn& column : columns) { headers.push_back(std::move(column.header)); }
    std::ranges::move(names.by_position, headers.begin());
    GYROLOG_TRY(std::vector<UnderstoodColumn> understood, understand_columns(headers, options, user_named));
    std::vector<RecordingColumn> read;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const bool is_force = understood[c].meaning && understood[c].meaning->kind == CsvColumn::Kind::force;
        if (is_force && !options.with_accelerometer) { continue; }
        RecordingColumn column{std::move(understood[c]), std::move(columns[c].values)};
        if (column.meaning) {
            GYROLOG_CHECK(check_numbers(column, options));
            take_means(column, options);
        } else {
            column.values.clear();
        }
        read.push_back(std::move(column));
    }
    return recording_of(std::move(read), std::move(name), options);
}

}  // namespace gyrolog
