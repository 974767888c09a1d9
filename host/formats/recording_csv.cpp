#include "host/formats/recording_csv.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/grid.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "host/base/printable.hpp"
#include "host/formats/csv_column.hpp"
#include "host/formats/csv_table.hpp"

namespace gyrolog {
namespace {

struct InputColumn {
    std::string header;
    std::optional<CsvColumn> meaning;  // nothing: ignored
    std::vector<double> values;

    bool is(CsvColumn::Kind kind) const { return meaning && meaning->kind == kind; }
    bool is_gyro() const { return meaning && meaning->is_gyro(); }
    bool is_accelerometer() const { return is(CsvColumn::Kind::force); }
};

// Beyond any gyro in any unit; squares of squares of it are still numbers.
constexpr double most_rate = 1e15;

// Without a given rate an empty field of t_s is an error.
CsvTable recording_table(const CsvReadOptions& options) {
    const bool needs_stamps = !options.rate_hz;
    const bool with_accelerometer = options.with_accelerometer;
    const bool needs_gyro = options.needs_gyro;
    const auto rule = [=](std::vector<CsvTableColumn>& columns) -> Status {
        bool any_sensor = false;
        for (CsvTableColumn& column : columns) {
            const auto meaning = csv_column(column.header);
            const bool is_force = meaning && meaning->kind == CsvColumn::Kind::force;
            column.used = meaning.has_value() && (with_accelerometer || !is_force);
            any_sensor = any_sensor || (column.used && is_force && !needs_gyro);
            if (meaning && meaning->is_gyro()) {
                column.lowest = -most_rate;
                column.highest = most_rate;
                column.needs_half = true;
            }
            any_sensor = any_sensor || (meaning && meaning->is_gyro());
            if (needs_stamps && meaning && meaning->kind == CsvColumn::Kind::time_stamp) {
                column.mend_if_empty = "no time stamp; give the sampling rate with --rate";
            }
        }
        if (any_sensor) { return {}; }
        return malformed(
            std::string("line 1: no gyro column") + (needs_gyro ? "" : " and none of an accelerometer") +
            "; it must name the columns with their units, such as t_s,gx_dps,gy_dps,gz_dps (or _rad_s, _lsb, "
            "_deg, _rad)" +
            (needs_gyro ? "" : " or ax_g,ay_g,az_g (or _m_s2, _lsb)"));
    };
    return {"t_s,gx_dps,gy_dps,gz_dps", rule, options.samples_per_row};
}

std::vector<InputColumn> input_columns(CsvTable& table) {
    std::vector<InputColumn> columns;
    for (CsvTableColumn& column : table.columns()) {
        auto meaning = csv_column(column.header);
        if (meaning && !column.used) { continue; }
        columns.push_back({column.header, std::move(meaning), std::move(column.values)});
    }
    return columns;
}

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
    std::vector<InputColumn> columns;  // known ones, without these two
    Grid grid;

    void keep(const std::vector<bool>& present) {
        if (std::ranges::all_of(present, [](bool stays) { return stays; })) { return; }
        punch_holes(grid, present);
        for (InputColumn& column : columns) { keep_rows(column.values, present); }
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

Result<Gridded> on_grid(std::vector<InputColumn> columns, const CsvReadOptions& options) {
    Gridded gridded;
    std::size_t rows = 0;
    for (InputColumn& column : columns) {
        if (!column.meaning) { continue; }
        rows = column.values.size();
        if (column.is(CsvColumn::Kind::time_stamp)) {
            gridded.t_s = std::move(column.values);
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
        return Error{ErrorCode::invalid_argument, "no column t_s: give the sampling rate with --rate"};
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
    const bool has_gyro = std::ranges::any_of(gridded.columns, &InputColumn::is_gyro);
    for (const InputColumn& column : gridded.columns) {
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
    for (InputColumn& column : gridded.columns) {
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

std::string unknown_columns(std::span<const InputColumn> columns) {
    std::string names;
    for (const InputColumn& column : columns) {
        if (!column.meaning) { names += (names.empty() ? "" : ", ") + column.header; }
    }
    return names.empty() ? names : "ignored columns of unknown name: " + names;
}

Result<Recording> recording_of(std::vector<InputColumn> columns, std::string name,
                               const CsvReadOptions& options) {
    Recording recording;
    recording.name = std::move(name);
    if (std::string warning = unknown_columns(columns); !warning.empty()) {
        recording.warnings.push_back(std::move(warning));
    }
    GYROLOG_TRY(Gridded gridded, on_grid(std::move(columns), options));
    drop_missing_samples(gridded);
    differentiate_angles(gridded, options.samples_per_row);
    if (options.samples_per_row == 1) { tell_stops(gridded.grid, gridded.stopped_s); }
    if (gridded.columns.front().values.empty()) { return malformed("no complete sample"); }
    std::stable_partition(gridded.columns.begin(), gridded.columns.end(),
                          [](const InputColumn& column) { return column.is_gyro(); });
    for (InputColumn& input : gridded.columns) {
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

Result<Recording> read_file(const std::string& path, const CsvReadOptions& options) {
    CsvTable table = recording_table(options);
    GYROLOG_CHECK(read_csv_file(table, path, options.rows_most + 1));
    return recording_of(input_columns(table), path.substr(path.find_last_of('/') + 1), options);
}

}  // namespace

Result<Recording> read_recording_csv(const std::string& path, const CsvReadOptions& options) {
    Result<Recording> recording = read_file(path, options);
    if (!recording.ok()) { return in_context("read '" + path + "'", std::move(recording).error()); }
    return recording;
}

Result<Recording> parse_recording_csv(std::string_view text, std::string name,
                                      const CsvReadOptions& options) {
    CsvTable table = recording_table(options);
    GYROLOG_CHECK(table.feed(text));
    GYROLOG_CHECK(table.finish());
    return recording_of(input_columns(table), std::move(name), options);
}

}  // namespace gyrolog
