// How a user names a device: "usb:", "usb:SERIAL", "tty:PATH", "sim:KEY=VALUE,...", "replay:FILE".
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
    std::vector<std::pair<std::string, std::string>> options;  // of sim, in the order written; each key once
};

// Error `invalid_argument` with the forms that are understood. Which options a simulated board has is not
// judged here.
Result<SourceUri> parse_source_uri(std::string_view text);

}  // namespace gyrolog
