// The recordings that make an array: one with several gyros, several of one time, or a virtual array.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "host/app/text_options.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct ArrayInput {
    std::vector<std::string> paths;  // files, or "sim:..." for boards= simulated boards
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
    TextChoice text{};
    std::optional<double> lsb_g{};
    SensorKind sensor = SensorKind::gyro;  // the accelerometer: as accelerometer_as_gyro() has it
    double simulated_s = 60.0;
    // Several files: by their first samples instead of by their clocks (device time on the host's clock of
    // captures, time stamps of text).
    bool align_starts = false;
};

// Those it is read from; of simulated boards their model, empty where they have none.
std::vector<std::string> files_of_array(const ArrayInput& input);

Result<Recording> read_array(const ArrayInput& input);

}  // namespace gyrolog
