#include "host/formats/csv_column.hpp"

#include <algorithm>
#include <array>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "host/formats/stamp_unit.hpp"

namespace gyrolog {
namespace {

using Kind = CsvColumn::Kind;

struct Unit {
    Kind kind;
    std::string_view written;  // after the axis
    std::string_view source_unit;
    std::string_view si;
    double scale;
};

constexpr std::array units = {
    Unit{Kind::rate, "dps", "dps", "rad/s", rad_per_deg},
    Unit{Kind::rate, "rad_s", "rad_s", "rad/s", 1.0},
    Unit{Kind::rate, "deg_h", "deg_h", "rad/s", rad_per_deg / s_per_h},
    Unit{Kind::rate, "mdps", "mdps", "rad/s", 1e-3 * rad_per_deg},
    Unit{Kind::rate, "lsb", "lsb", "rad/s", 1.0},
    Unit{Kind::angle, "deg", "dps", "rad/s", rad_per_deg},
    Unit{Kind::angle, "rad", "rad_s", "rad/s", 1.0},
    Unit{Kind::angle_increment, "deg", "dps", "rad/s", rad_per_deg},
    Unit{Kind::angle_increment, "rad", "rad_s", "rad/s", 1.0},
    Unit{Kind::force, "g", "g", "m/s^2", standard_gravity_m_s2},
    Unit{Kind::force, "m_s2", "m_s2", "m/s^2", 1.0},
    Unit{Kind::force, "mg", "mg", "m/s^2", 1e-3 * standard_gravity_m_s2},
    Unit{Kind::force, "lsb", "lsb", "m/s^2", 1.0},
    Unit{Kind::reference, "dps", "dps", "rad/s", rad_per_deg},
    Unit{Kind::reference, "rad_s", "rad_s", "rad/s", 1.0},
};

bool is_axis(char c) { return c >= 'x' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<CsvColumn> column_with_unit(std::string name, std::string_view written,
                                          std::initializer_list<Kind> kinds) {
    for (const Kind kind : kinds) {
        for (const Unit& unit : units) {
            if (unit.kind == kind && unit.written == written) {
                return CsvColumn{kind, std::move(name), std::string(unit.si), std::string(unit.source_unit),
                                 unit.scale};
            }
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<CsvColumn> csv_column(std::string_view header) {
    for (const StampUnit& unit : stamp_units) {
        if (header.starts_with("t_") && header.substr(2) == unit.name) {
            return CsvColumn{Kind::time_stamp, "t", "s", std::string(header.substr(2)), 1.0, unit.per_s};
        }
    }
    if (header == stopped_column) { return CsvColumn{Kind::stop, "stopped", "s", "s", 1.0}; }
    if (header == "temp_C") { return CsvColumn{Kind::temperature, "temp", "degC", "C", 1.0}; }
    constexpr std::array quaternion = {"ref_qw", "ref_qx", "ref_qy", "ref_qz"};
    if (std::ranges::find(quaternion, header) != quaternion.end()) {
        return CsvColumn{Kind::reference, std::string(header), "", "", 1.0};
    }
    constexpr std::string_view reference = "ref_";
    if (header.starts_with(reference)) {
        if (header.size() < 7 || !is_axis(header[4]) || header[5] != '_') { return std::nullopt; }
        return column_with_unit(std::string(header.substr(0, 5)), header.substr(6), {Kind::reference});
    }
    const bool increment = header.starts_with("dg");
    const std::string_view rest = increment ? header.substr(1) : header;
    if (rest.size() < 2 || (rest[0] != 'g' && rest[0] != 'a') || !is_axis(rest[1])) { return std::nullopt; }
    std::size_t end = 2;
    while (end < rest.size() && is_digit(rest[end])) { ++end; }
    if (end >= rest.size() || rest[end] != '_') { return std::nullopt; }
    std::string name(rest.substr(0, end));
    const std::string_view written = rest.substr(end + 1);
    if (increment) { return column_with_unit(std::move(name), written, {Kind::angle_increment}); }
    if (rest[0] == 'a') { return column_with_unit(std::move(name), written, {Kind::force}); }
    return column_with_unit(std::move(name), written, {Kind::rate, Kind::angle});
}

}  // namespace gyrolog
