// What is known of a recording beside the numbers that its analysis gives.
#pragma once

#include <optional>
#include <string>

namespace gyrolog {

struct RecordingFacts {
    std::string board;                    // its serial number, or of a virtual one its URI; empty: not known
    std::string started;                  // "2026-11-21T05:04:55.123456789Z"; empty: not known
    std::optional<double> temperature_C;  // mean of the sensor's thermometer
};

}  // namespace gyrolog
