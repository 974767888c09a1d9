// From a recording, and a model if one is given, to a page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/part_choice.hpp"
#include "host/app/text_options.hpp"

namespace gyrolog {

struct ReportRequest {
    std::string recording_path;
    std::string model_path;  // empty: no diagnosis
    std::string page_path;
    std::optional<double> rate_hz;  // in place of the one in the file
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g{};
    PartChoice part{};
    TextChoice text{};
    std::size_t simulations = 200;
    std::uint64_t seed = 1;
};

ExitCode report_to_file(Console& console, const ReportRequest& request);

}  // namespace gyrolog
