// What a capture's stops are called wherever it is told of.
#pragma once

#include <cstdint>
#include <string>

namespace gyrolog {

// "stopped by the user for 2.01 s"; of several "stopped by the user 3 times, for 12.4 s in all".
std::string stops_text(std::uint64_t stops, double stopped_s);

}  // namespace gyrolog
