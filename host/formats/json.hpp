// JSON whose keys stay in the order in which they were written.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "host/formats/json_fwd.hpp"

namespace gyrolog {

// As a file's text. What a device or a file's name says need not be UTF-8, which JSON is: such bytes become
// U+FFFD.
inline std::string written_out(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gyrolog
