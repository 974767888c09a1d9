// How a user names a device: "usb:", "usb:SERIAL", "tty:PATH[,speed=BAUD]", "sim:KEY=VALUE,...",
// "replay:FILE".
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

struct SourceUri {
    enum class Kind { usb, tty, sim, replay };

    Kind kind = Kind::usb;
    std::string rest;  // behind the colon: a serial number (may be empty), a path, options, a file
    // Of sim, in the order written, each key once; of tty, the speed.
    std::vector<std::pair<std::string, std::string>> options;
};

// Error `invalid_argument` with the forms that are understood. Which options a simulated board has is not
// judged here. A path may hold commas: only what begins with ",speed=" at its end is none of it.
Result<SourceUri> parse_source_uri(std::string_view text);

}  // namespace gyrolog
