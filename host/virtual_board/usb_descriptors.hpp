// What the board tells of itself when a host enumerates it (USB 2.0, 9.6; CDC 1.2, 5.2.3; PSTN 1.2, 5.3).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host/base/bytes.hpp"

namespace gyrolog {

inline constexpr std::string_view virtual_board_manufacturer = "gyrolog";
inline constexpr std::string_view virtual_board_product = "gyrolog MPU-9250 virtual board";

Bytes device_descriptor();
Bytes configuration_descriptor();  // with its interfaces, functional descriptors and endpoints
// Index 0: the languages. Nothing for an index that no descriptor names.
std::optional<Bytes> string_descriptor(std::uint8_t index, std::string_view serial);

}  // namespace gyrolog
