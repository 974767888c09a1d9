// How wide a text stands on a terminal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace gyrolog {

inline constexpr std::size_t terminal_width = 80;

// Characters of UTF-8: every byte but the continuation bytes.
inline std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(
        text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) != 0x80U; }));
}

}  // namespace gyrolog
