#include "host/transport/raw_frame.hpp"

#include <gyrolog_protocol/cobs.h>
#include <gyrolog_protocol/crc.h>
#include <gyrolog_protocol/frame.h>

namespace gyrolog {

Bytes RawFrame::head() const {
    Bytes body;
    body.reserve(GLP_FRAME_BODY_MAX);
    const auto put = [&body](std::uint32_t value, unsigned bytes) {
        for (unsigned i = 0; i < bytes; ++i) { body.push_back(static_cast<std::uint8_t>(value >> (8U * i))); }
    };
    put(version, 1);
    put(type, 1);
    put(flags, 2);
    put(sequence, 4);
    body.insert(body.end(), payload.begin(), payload.end());
    return body;
}

Bytes RawFrame::wire(std::uint32_t checksum_error) const {
    Bytes body = head();
    const std::uint32_t checksum = glp_crc32(body.data(), body.size()) ^ checksum_error;
    for (unsigned shift = 0; shift < 32U; shift += 8U) {
        body.push_back(static_cast<std::uint8_t>(checksum >> shift));
    }
    return wire_of_body(body);
}

Bytes wire_of_body(ByteView body) {
    Bytes wire(GLP_COBS_ENCODED_MAX(body.size()) + 2);
    const std::size_t size = glp_cobs_encode(body.data(), body.size(), wire.data() + 1, wire.size() - 2).size;
    wire.resize(size + 2);
    wire.front() = wire.back() = 0;
    return wire;
}

}  // namespace gyrolog
