// Places of a gap in words.
#pragma once

#include <string>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// "x axis, averaging times 60 s to 15 min"; "" for a place without anything.
std::string place_text(const Place& place);

}  // namespace gyrolog
