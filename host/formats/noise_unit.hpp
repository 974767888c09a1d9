// Units of the noise coefficients, written for the unit of what is sensed.
#pragma once

#include <string>
#include <vector>

#include "analysis/noise/noise_fit.hpp"
#include "analysis/noise/sensor_unit.hpp"

namespace gyrolog {

// "dps*s", "dps/sqrt(Hz)", "dps", "dps*sqrt(Hz)", "dps/s"
inline std::string noise_unit(NoiseTerm term, const SensorUnit& unit) {
    switch (term) {
        case NoiseTerm::Q:
            return unit.name + "*s";
        case NoiseTerm::N:
            return unit.name + "/sqrt(Hz)";
        case NoiseTerm::B:
            return unit.name;
        case NoiseTerm::K:
            return unit.name + "*sqrt(Hz)";
        case NoiseTerm::R:
            return unit.name + "/s";
    }
    return unit.name;
}

// The same for people: "dps/√Hz", "deg/√h" of "deg/sqrt(h)".
std::string with_root_signs(std::string unit);

struct ScaledUnit {
    std::string name;
    double per_column_unit = 1.0;  // what 1 of the column's own unit is
};

// The units in which people state a term, as a page prints them: of a gyro's N "rad/s/√Hz", "°/s/√Hz",
// "°/h/√Hz", "°/√h", of an accelerometer's "m/s²/√Hz", "µg/√Hz", "m/s/√h". Counts have their own only.
std::vector<ScaledUnit> printed_units(NoiseTerm term, const SensorUnit& unit);
// The same of what is sensed: "rad/s", "°/s", "°/h"; "m/s²", "g".
std::vector<ScaledUnit> printed_signal_units(const SensorUnit& unit);

}  // namespace gyrolog
