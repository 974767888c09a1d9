// Units of the noise coefficients, written for the unit of what is sensed.
#pragma once

#include <string>

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

}  // namespace gyrolog
