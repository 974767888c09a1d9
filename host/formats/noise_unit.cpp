#include "host/formats/noise_unit.hpp"

#include <cstddef>
#include <string_view>

namespace gyrolog {
namespace {

constexpr double sqrt_s_per_sqrt_h = 60.0;
constexpr double arcsec_per_deg = 3600.0;

// In m/s^2 and what comes of it; noise in micro-g as data sheets have it.
std::vector<ScaledUnit> printed_force_units(NoiseTerm term) {
    const double micro_g = SensorUnit::micro_g().per_column_unit;
    switch (term) {
        case NoiseTerm::Q:
            return {{"m/s", 1.0}};
        case NoiseTerm::N:
            return {{"m/s²/√Hz", 1.0}, {"µg/√Hz", micro_g}, {"m/s/√h", sqrt_s_per_sqrt_h}};
        case NoiseTerm::B:
            return {{"m/s²", 1.0}, {"µg", micro_g}};
        case NoiseTerm::K:
            return {{"m/s²·√Hz", 1.0}, {"µg·√Hz", micro_g}};
        case NoiseTerm::R:
            return {{"m/s³", 1.0}, {"µg/s", micro_g}};
    }
    return {};
}

}  // namespace

std::string with_root_signs(std::string unit) {
    const std::string_view root = "sqrt(";
    for (std::size_t at = unit.find(root); at != std::string::npos; at = unit.find(root)) {
        unit.erase(unit.find(')', at), 1);
        unit.replace(at, root.size(), "√");
    }
    return unit;
}

std::vector<ScaledUnit> printed_units(NoiseTerm term, const SensorUnit& unit) {
    if (unit.is_counts()) { return {{noise_unit(term, unit), unit.per_column_unit}}; }
    if (unit.sensor == SensorKind::accelerometer) { return printed_force_units(term); }
    constexpr double deg = deg_per_rad;
    switch (term) {
        case NoiseTerm::Q:
            return {{"rad", 1.0}, {"°", deg}, {"arcsec", deg * arcsec_per_deg}};
        case NoiseTerm::N:
            return {{"rad/s/√Hz", 1.0},
                    {"°/s/√Hz", deg},
                    {"°/h/√Hz", deg * s_per_h},
                    {"°/√h", deg * sqrt_s_per_sqrt_h}};
        case NoiseTerm::B:
            return printed_signal_units(unit);
        case NoiseTerm::K:
            return {{"rad/s·√Hz", 1.0}, {"°/s·√Hz", deg}, {"°/h/√h", deg * s_per_h * sqrt_s_per_sqrt_h}};
        case NoiseTerm::R:
            return {{"rad/s²", 1.0}, {"°/s²", deg}, {"°/h²", deg * s_per_h * s_per_h}};
    }
    return {};
}

std::vector<ScaledUnit> printed_signal_units(const SensorUnit& unit) {
    if (unit.is_counts()) { return {{unit.name, unit.per_column_unit}}; }
    if (unit.sensor == SensorKind::accelerometer) {
        return {{"m/s²", 1.0}, {"g", SensorUnit::g().per_column_unit}};
    }
    return {{"rad/s", 1.0}, {"°/s", deg_per_rad}, {"°/h", deg_per_rad * s_per_h}};
}

}  // namespace gyrolog
