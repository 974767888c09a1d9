// Units of the noise coefficients, written for a unit of rate.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"

namespace gyrolog {

// "dps*s", "dps/sqrt(Hz)", "dps", "dps*sqrt(Hz)", "dps/s"
inline std::string noise_unit(NoiseTerm term, const RateUnit& unit) {
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
