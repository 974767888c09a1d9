#include "host/fleet/fleet_table.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

// What a row is of.
struct Row {
    const FleetLine& recording;
    const FleetAxis* axis;  // null: of none
    std::string outlier;
};

// A name or a message from outside may hold what a terminal obeys, and line breaks.
Cell cell(const std::string& text) { return text.empty() ? Cell() : Cell(printable(text)); }
Cell cell(const std::optional<double>& number) { return number ? Cell(*number) : Cell(); }
Cell cell(const std::optional<std::uint64_t>& number) {
    if (!number || *number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
        return {};
    }
    return static_cast<std::int64_t>(*number);
}

std::string causes_text(const Row& row) {
    std::string text;
    for (const FleetCause& cause : row.recording.causes) {
        const bool is_of_axis =
            row.axis == nullptr || cause.axes.empty() || std::ranges::count(cause.axes, row.axis->axis) > 0;
        if (!is_of_axis) { continue; }
        text += (text.empty() ? "" : ";") + cause.effect;
        if (cause.share) { text += fmt::format("={:.3g}", *cause.share); }
    }
    return text;
}

Cell of_axis(const Row& row, std::string FleetAxis::*text) {
    return row.axis == nullptr ? Cell() : cell(row.axis->*text);
}

template <std::size_t coefficient>
Cell coefficient_of(const Row& row, std::optional<double> FleetNumber::*number) {
    return row.axis == nullptr ? Cell() : cell(row.axis->coefficients.at(coefficient).*number);
}

struct ColumnSource {
    TableColumn column;
    Cell (*cell_of)(const Row& row);
};

template <std::size_t coefficient>
constexpr std::array<ColumnSource, 3> columns_of_coefficient(const char* value, const char* sd,
                                                             const char* upper) {
    return {
        ColumnSource{{value, CellKind::real},
                     [](const Row& row) { return coefficient_of<coefficient>(row, &FleetNumber::value); }},
        ColumnSource{{sd, CellKind::real},
                     [](const Row& row) { return coefficient_of<coefficient>(row, &FleetNumber::sd); }},
        ColumnSource{{upper, CellKind::real},
                     [](const Row& row) { return coefficient_of<coefficient>(row, &FleetNumber::upper); }}};
}

constexpr std::array of_recording{
    ColumnSource{{"file", CellKind::text}, [](const Row& row) { return cell(row.recording.file); }},
    ColumnSource{{"board", CellKind::text}, [](const Row& row) { return cell(row.recording.board); }},
    ColumnSource{{"started", CellKind::text}, [](const Row& row) { return cell(row.recording.started); }},
    ColumnSource{{"sensor", CellKind::text}, [](const Row& row) { return of_axis(row, &FleetAxis::sensor); }},
    ColumnSource{{"axis", CellKind::text}, [](const Row& row) { return of_axis(row, &FleetAxis::axis); }},
    ColumnSource{{"unit", CellKind::text}, [](const Row& row) { return of_axis(row, &FleetAxis::unit); }},
    ColumnSource{{"rate_hz", CellKind::real}, [](const Row& row) { return cell(row.recording.rate_hz); }},
    ColumnSource{{"duration_s", CellKind::real},
                 [](const Row& row) { return cell(row.recording.duration_s); }},
    ColumnSource{{"samples", CellKind::whole}, [](const Row& row) { return cell(row.recording.samples); }},
    ColumnSource{{"missing", CellKind::whole}, [](const Row& row) { return cell(row.recording.missing); }},
    ColumnSource{{"temperature_C", CellKind::real},
                 [](const Row& row) { return cell(row.recording.temperature_C); }},
    ColumnSource{{"end", CellKind::text}, [](const Row& row) { return cell(row.recording.end); }},
    ColumnSource{{"bias", CellKind::real},
                 [](const Row& row) { return row.axis == nullptr ? Cell() : cell(row.axis->bias.value); }},
    ColumnSource{{"bias_sd", CellKind::real},
                 [](const Row& row) { return row.axis == nullptr ? Cell() : cell(row.axis->bias.sd); }},
};

// In the order of fleet_coefficients.
constexpr std::array of_coefficients{
    columns_of_coefficient<0>("Q", "Q_sd", "Q_upper"), columns_of_coefficient<1>("N", "N_sd", "N_upper"),
    columns_of_coefficient<2>("B", "B_sd", "B_upper"), columns_of_coefficient<3>("K", "K_sd", "K_upper"),
    columns_of_coefficient<4>("R", "R_sd", "R_upper"),
};

constexpr std::array of_answers{
    ColumnSource{{"verdict", CellKind::text}, [](const Row& row) { return cell(row.recording.verdict); }},
    ColumnSource{{"causes", CellKind::text}, [](const Row& row) { return cell(causes_text(row)); }},
    ColumnSource{{"gap_before", CellKind::real},
                 [](const Row& row) { return cell(row.recording.gap_before); }},
    ColumnSource{{"gap_named", CellKind::real}, [](const Row& row) { return cell(row.recording.gap_named); }},
    ColumnSource{{"gap_after", CellKind::real}, [](const Row& row) { return cell(row.recording.gap_after); }},
    ColumnSource{{"comparison", CellKind::text},
                 [](const Row& row) { return of_axis(row, &FleetAxis::comparison); }},
    ColumnSource{{"outlier", CellKind::text}, [](const Row& row) { return cell(row.outlier); }},
    ColumnSource{
        {"exit", CellKind::whole},
        [](const Row& row) { return row.recording.exit ? Cell(std::int64_t{*row.recording.exit}) : Cell(); }},
    ColumnSource{{"error", CellKind::text}, [](const Row& row) { return cell(row.recording.error); }},
    ColumnSource{{"version", CellKind::text}, [](const Row& row) { return cell(row.recording.version); }},
    ColumnSource{{"seed", CellKind::whole}, [](const Row& row) { return cell(row.recording.seed); }},
    ColumnSource{{"seconds", CellKind::real}, [](const Row& row) { return cell(row.recording.seconds); }},
};

std::vector<ColumnSource> all_columns() {
    std::vector<ColumnSource> all(of_recording.begin(), of_recording.end());
    for (const auto& three : of_coefficients) { all.insert(all.end(), three.begin(), three.end()); }
    all.insert(all.end(), of_answers.begin(), of_answers.end());
    return all;
}

// Those of the recording's axis; what belongs to no axis is in all of its rows.
std::string outlier_text(std::span<const OutlyingParameter> outliers, std::size_t recording,
                         const std::string& axis) {
    std::string text;
    for (const OutlyingParameter& one : outliers) {
        if (one.recording != recording || (!one.axis.empty() && one.axis != axis)) { continue; }
        text += fmt::format("{}{}={:+.1f}", text.empty() ? "" : ";", one.name, one.z);
    }
    return text;
}

bool is_wanted(const FleetAxis& axis, Sensors sensors) {
    return includes(sensors, axis.sensor == "gyro" ? SensorKind::gyro : SensorKind::accelerometer);
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) { return text; }
    std::string quoted = "\"";
    for (const char c : text) { quoted.append(c == '"' ? 2 : 1, c); }
    return quoted + '"';
}

std::string csv_text(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) { return quoted(*text); }
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) { return fmt::format("{}", *whole); }
    if (const auto* real = std::get_if<double>(&cell)) { return fmt::format("{}", *real); }
    return {};
}

}  // namespace

FleetTable fleet_table(std::span<const FleetLine> recordings, std::span<const OutlyingParameter> outliers,
                       Sensors sensors) {
    const std::vector<ColumnSource> sources = all_columns();
    FleetTable table;
    table.columns.reserve(sources.size());
    for (const ColumnSource& source : sources) { table.columns.push_back(source.column); }
    const auto add = [&](const Row& row) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        cells.reserve(sources.size());
        for (const ColumnSource& source : sources) { cells.push_back(source.cell_of(row)); }
    };
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        const FleetLine& recording = recordings[i];
        const std::size_t before = table.rows.size();
        for (const FleetAxis& axis : recording.axes) {
            if (!is_wanted(axis, sensors)) { continue; }
            const bool is_gyro = axis.sensor == "gyro";
            add({recording, &axis, is_gyro ? outlier_text(outliers, i, axis.axis) : std::string()});
        }
        if (table.rows.size() == before) { add({recording, nullptr, outlier_text(outliers, i, "")}); }
    }
    return table;
}

std::string as_csv(const FleetTable& table) {
    std::string text;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        text += (i == 0 ? "" : ",") + std::string(table.columns[i].name);
    }
    text += '\n';
    for (const std::vector<Cell>& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i) { text += (i == 0 ? "" : ",") + csv_text(row[i]); }
        text += '\n';
    }
    return text;
}

}  // namespace gyrolog
