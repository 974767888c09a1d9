// Results on their way to a file or to standard output.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "host/app/console.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// `path` "-" is the console's `out`. A file is replaced whole or not at all.
// JSON gains the key "reported_by", with program_name().
Status write_json(Console& console, const std::string& path, nlohmann::ordered_json answer);
Status write_text(Console& console, const std::string& path, const std::string& text);

}  // namespace gyrolog
