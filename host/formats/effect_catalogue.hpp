// The effects that a model may list, told to people and to programs.
#pragma once

#include <string>

#include "host/formats/json_fwd.hpp"

namespace gyrolog {

// Every effect in the order of its action: formula, parameters with meaning and plausible range, source.
std::string effect_catalogue_text();
Json effect_catalogue_json();  // schema gyrolog-effects/1

}  // namespace gyrolog
