// What `gyrolog calibrate` does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/text_options.hpp"

namespace gyrolog {

struct CalibrationRequest {
    std::vector<std::string> recordings;
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g;
    TextChoice text{};
    std::optional<double> turn_deg;
    std::optional<double> turn_sd_deg;
    std::optional<double> gravity_m_s2;
    std::string json_path;  // "-" is standard output; empty: not wanted, as the others
    std::string model_path;
    std::string px4_path;
    std::string ardupilot_path;
    std::string header_path;
};

// Failed where nothing but the gyro's bias is determined: the message says what is missing and what to add.
ExitCode run_calibration(Console& console, const CalibrationRequest& request);

}  // namespace gyrolog
