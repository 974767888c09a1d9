// Frames as byte vectors, for tests.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/frame_stream.h>

namespace gyrolog {

using WireBytes = std::vector<std::uint8_t>;

inline WireBytes cobs_encoded(const WireBytes& plain) {
    WireBytes encoded(GLP_COBS_ENCODED_MAX(plain.size()));
    encoded.resize(glp_cobs_encode(plain.data(), plain.size(), encoded.data(), encoded.size()).size);
    return encoded;
}

inline WireBytes frame_on_wire(std::uint8_t type, std::uint32_t sequence, const WireBytes& payload) {
    const glp_frame frame{type, 0, sequence, payload.data(), payload.size()};
    WireBytes wire(GLP_FRAME_WIRE_MAX);
    wire.resize(glp_frame_encode(&frame, wire.data(), wire.size()).size);
    return wire;
}

inline WireBytes random_bytes(std::mt19937& random, std::size_t size) {
    WireBytes bytes(size);
    for (std::uint8_t& byte : bytes) { byte = static_cast<std::uint8_t>(random()); }
    return bytes;
}

// Feeds a stream in one call per piece and calls `on_frame(frame)` for each frame.
template <typename OnFrame>
void feed(glp_stream& stream, const std::uint8_t* bytes, std::size_t size, OnFrame on_frame) {
    while (size > 0) {
        glp_frame frame{};
        bool have_frame = false;
        const std::size_t taken = glp_stream_push(&stream, bytes, size, &frame, &have_frame);
        bytes += taken;
        size -= taken;
        if (have_frame) { on_frame(frame); }
    }
}

inline bool accounts_hold(const glp_stream& stream) {
    return stream.bytes_in == stream.bytes_in_frames + stream.bytes_skipped + glp_stream_buffered(&stream);
}

}  // namespace gyrolog
