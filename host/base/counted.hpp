// Numbers of things, as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gyrolog {

// 4320000 as "4,320,000".
std::string format_count(std::uint64_t count);

// "1 sample", "0 samples", "4,320,000 samples": `noun` in the singular.
std::string counted(std::uint64_t count, std::string_view noun);

}  // namespace gyrolog
