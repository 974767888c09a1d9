#include "host/formats/curve_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/csv_table.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

// Wide enough for any sensor and narrow enough that squares stay finite.
constexpr double smallest_read = 1e-15;
constexpr double largest_read = 1e15;

struct CurveUnit {
    std::string_view ending;
    double si;  // rad/s, or m/s^2
    SensorKind sensor = SensorKind::gyro;
    bool is_si = false;
};

constexpr std::array curve_units = {
    CurveUnit{"_dps", rad_per_deg},
    CurveUnit{"_deg_per_s", rad_per_deg},
    CurveUnit{"_deg_per_h", rad_per_deg / 3600.0},
    CurveUnit{"_rad_s", 1.0, SensorKind::gyro, true},
    CurveUnit{"_g", standard_gravity_m_s2, SensorKind::accelerometer},
    CurveUnit{"_mg", 1e-3 * standard_gravity_m_s2, SensorKind::accelerometer},
    CurveUnit{"_ug", 1e-6 * standard_gravity_m_s2, SensorKind::accelerometer},
    CurveUnit{"_m_s2", 1.0, SensorKind::accelerometer, true},
};

SensorUnit shown_unit(const CurveUnit& unit) {
    if (unit.sensor == SensorKind::gyro) { return unit.is_si ? SensorUnit::rad_per_s() : SensorUnit::dps(); }
    return unit.is_si ? SensorUnit::m_per_s2() : SensorUnit::g();
}

struct Deviation {
    std::string name;
    const CurveUnit* unit;
};

std::optional<Deviation> deviation_of(std::string_view header) {
    for (const CurveUnit& unit : curve_units) {
        if (header.size() > unit.ending.size() && header.ends_with(unit.ending)) {
            return Deviation{std::string(header.substr(0, header.size() - unit.ending.size())), &unit};
        }
    }
    return std::nullopt;
}

Status judge_header(std::vector<CsvTableColumn>& columns) {
    constexpr const char* example = "such as tau_s,x_dps,y_dps (or _deg_per_h, _rad_s; _g, _m_s2)";
    bool tau = false;
    std::vector<std::string> names;
    std::set<SensorKind> sensors;
    for (CsvTableColumn& column : columns) {
        const auto deviation = deviation_of(column.header);
        if (column.header == "tau_s") {
            tau = true;
            column.mend_if_empty = "no averaging time";
        } else if (!deviation) {
            continue;
        } else if (std::ranges::find(names, deviation->name) != names.end()) {
            return malformed("curve " + in_quotes(deviation->name) + " appears twice, in different units");
        } else {
            sensors.insert(deviation->unit->sensor);
            names.push_back(deviation->name);
        }
        column.used = true;
        column.lowest = smallest_read;
        column.highest = largest_read;
    }
    if (!tau) { return malformed(fmt::format("no column tau_s; it must name the columns, {}", example)); }
    if (names.empty()) {
        return malformed(fmt::format("no deviation; it must name the columns with their units, {}", example));
    }
    if (sensors.size() > 1) {
        return malformed("curves of a gyro and of an accelerometer; give each a file");
    }
    return {};
}

AllanCurve curve_of(const std::vector<double>& tau_s, const std::vector<double>& values, double si) {
    AllanCurve curve;
    for (std::size_t i = 0; i < tau_s.size(); ++i) {
        if (std::isnan(values[i])) { continue; }
        AllanPoint point;
        point.tau_s = tau_s[i];
        point.deviation = values[i] * si;
        point.lo = point.deviation;
        point.hi = point.deviation;
        curve.points.push_back(point);
    }
    std::ranges::stable_sort(curve.points, {}, &AllanPoint::tau_s);
    return curve;
}

Result<PrintedCurves> curves_of(std::vector<CsvTableColumn>& columns, std::string name) {
    PrintedCurves curves;
    curves.name = std::move(name);
    const auto tau = std::ranges::find(columns, "tau_s", &CsvTableColumn::header);
    std::string ignored;
    for (CsvTableColumn& column : columns) {
        if (!column.used) { ignored += (ignored.empty() ? "" : ", ") + column.header; }
        const auto deviation = deviation_of(column.header);
        if (!deviation) { continue; }
        if (curves.curves.empty()) { curves.unit = shown_unit(*deviation->unit); }
        AllanCurve curve = curve_of(tau->values, column.values, deviation->unit->si);
        if (curve.points.size() < curve_fit_points_min) {
            return malformed(fmt::format("column {}: {} points; a model needs {} at least",
                                         in_quotes(column.header), curve.points.size(),
                                         curve_fit_points_min));
        }
        curves.curves.push_back({deviation->name, std::move(curve)});
    }
    if (!ignored.empty()) {
        curves.warnings.push_back("ignored columns of unknown name or unit: " + ignored);
    }
    return curves;
}

CsvTable curve_table() {
    CsvTableForm form;
    form.example = "tau_s,x_dps,y_dps,z_dps";
    return {std::move(form), judge_header};
}

bool is_capture(const std::string& path) {
    auto reader = TextReader::open(path);
    if (!reader.ok()) { return false; }
    const auto beginning = reader->read();
    return beginning.ok() && begins_as_capture(*beginning);
}

Result<PrintedCurves> read_file(const std::string& path) {
    if (is_capture(path)) {
        return malformed("this is a capture, not an Allan curve: give it as RECORDING, without --curve");
    }
    CsvTable table = curve_table();
    GYROLOG_CHECK(read_csv_file(table, path));
    return curves_of(table.columns(), path.substr(path.find_last_of('/') + 1));
}

}  // namespace

Result<PrintedCurves> read_curve_csv(const std::string& path) {
    Result<PrintedCurves> curves = read_file(path);
    if (!curves.ok()) { return in_context("read '" + path + "'", std::move(curves).error()); }
    return curves;
}

Result<PrintedCurves> parse_curve_csv(std::string_view text, std::string name) {
    CsvTable table = curve_table();
    GYROLOG_CHECK(table.feed(text));
    GYROLOG_CHECK(table.finish());
    return curves_of(table.columns(), std::move(name));
}

}  // namespace gyrolog
