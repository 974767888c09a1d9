// How simulators' files are written, for simulator_file.cpp. Each is told of in its file.
#pragma once

#include "host/formats/simulators/simulator_file.hpp"

namespace gyrolog {

struct SimulatorText {
    bool (*begins_so)(std::string_view text);  // told by little of it
    Result<std::unique_ptr<SimulatorFile>> (*open)(std::string_view text);
};

extern const SimulatorText airsim_settings_text;
extern const SimulatorText kalibr_imu_text;
extern const SimulatorText xml_sensors_text;

inline std::string_view without_leading_blanks(std::string_view text) {
    const std::size_t from = text.find_first_not_of(" \t\r\n");
    return from == std::string_view::npos ? std::string_view() : text.substr(from);
}

}  // namespace gyrolog
