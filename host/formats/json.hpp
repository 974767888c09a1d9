// JSON whose keys stay in the order in which they were written.
#pragma once

#include <nlohmann/json.hpp>

namespace gyrolog {

using Json = nlohmann::ordered_json;

}  // namespace gyrolog
