// A frame put together by hand: of any version, with any checksum. The codec writes neither.
#pragma once

#include <cstdint>

#include "host/base/bytes.hpp"

namespace gyrolog {

struct RawFrame {
    std::uint8_t version = 1;
    std::uint8_t type = 0;
    std::uint16_t flags = 0;
    std::uint32_t sequence = 0;
    Bytes payload;

    // Header and payload, without the checksum.
    Bytes head() const;
    // On the wire with both delimiters; `checksum_error` is what the checksum differs by from the right one.
    Bytes wire(std::uint32_t checksum_error = 0) const;
};

// Any body at all in its COBS form, between two delimiters.
Bytes wire_of_body(ByteView body);

}  // namespace gyrolog
