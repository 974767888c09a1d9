// What the board tells of itself when a host enumerates it (USB 2.0, 9.6; CDC 1.2, 5.2.3; PSTN 1.2, 5.3).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host/base/bytes.hpp"

namespace gyrolog {

inline constexpr std::string_view virtual_board_manufacturer = "gyrolog";
inline constexpr std::string_view virtual_board_product = "gyrolog MPU-9250 virtual board";

// The addresses of its endpoints, which SPEC.md 10.2 leaves to the board.
struct UsbEndpoints {
    std::uint8_t in = 0x81;
    std::uint8_t out = 0x01;
    std::uint8_t notify = 0x82;
};
// As on LPC175x/6x, 177x/8x and 40xx, where the number fixes the kind: 1, 4, 7 ... are interrupt endpoints;
// 2, 5, 8 ... bulk; 3, 6, 9 ... isochronous (UM10360, chapter 11, "Fixed endpoint configuration").
inline constexpr UsbEndpoints fixed_kind_endpoints{.in = 0x82, .out = 0x02, .notify = 0x81};

Bytes device_descriptor();
// With its interfaces, functional descriptors and endpoints.
Bytes configuration_descriptor(const UsbEndpoints& endpoints = {});
// Index 0: the languages. Nothing for an index that no descriptor names.
std::optional<Bytes> string_descriptor(std::uint8_t index, std::string_view serial);

}  // namespace gyrolog
