// What a sensor measures, and the unit in which its numbers are shown.
#pragma once

#include <string>
#include <string_view>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {

enum class SensorKind { gyro, accelerometer };

// Which sensors of a recording are wanted.
enum class Sensors { gyro, accelerometer, all };

// "gyro", "accelerometer"; whatever else: all.
constexpr Sensors sensors_named(std::string_view name) {
    if (name == "gyro") { return Sensors::gyro; }
    return name == "accelerometer" ? Sensors::accelerometer : Sensors::all;
}

constexpr bool includes(Sensors sensors, SensorKind kind) {
    return sensors == Sensors::all ||
           (sensors == Sensors::gyro ? kind == SensorKind::gyro : kind == SensorKind::accelerometer);
}

// Everything in a report is in the columns' own unit: rad/s, m/s^2, or lsb without a scale. This is the one
// for its readers.
struct SensorUnit {
    std::string name = "dps";
    double per_column_unit = 1.0;
    SensorKind sensor = SensorKind::gyro;

    static SensorUnit dps() { return {"dps", deg_per_rad}; }
    static SensorUnit rad_per_s() { return {"rad/s", 1.0}; }
    static SensorUnit g() { return {"g", 1.0 / standard_gravity_m_s2, SensorKind::accelerometer}; }
    static SensorUnit micro_g() { return {"ug", 1e6 / standard_gravity_m_s2, SensorKind::accelerometer}; }
    static SensorUnit m_per_s2() { return {"m/s^2", 1.0, SensorKind::accelerometer}; }
    static SensorUnit counts_of(SensorKind sensor) { return {"lsb", 1.0, sensor}; }

    bool is_counts() const { return name == "lsb"; }
};

using RateUnit = SensorUnit;  // where it is a gyro's

}  // namespace gyrolog
