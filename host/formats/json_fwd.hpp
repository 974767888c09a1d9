// The name of what json.hpp defines.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "host/formats/ordered_object.hpp"

namespace gyrolog {

using Json = nlohmann::basic_json<OrderedObject>;

}  // namespace gyrolog
