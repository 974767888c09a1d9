// Little-endian numbers in bytes.
#pragma once

#include <cstdint>
#include <type_traits>

#include "host/base/bytes.hpp"

namespace gyrolog {

template <typename Number>
void put(Bytes& out, std::type_identity_t<Number> number) {
    using Bits = std::make_unsigned_t<Number>;
    const auto bits = static_cast<Bits>(number);
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        out.push_back(static_cast<std::uint8_t>(bits >> (8U * i)));
    }
}

template <typename Number>
Number get(ByteView bytes, std::size_t offset) {
    using Bits = std::make_unsigned_t<Number>;
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        bits = static_cast<Bits>(bits | static_cast<Bits>(static_cast<Bits>(bytes[offset + i]) << (8U * i)));
    }
    return static_cast<Number>(bits);
}

}  // namespace gyrolog
