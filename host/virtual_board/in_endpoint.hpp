// A bulk IN endpoint between the firmware that fills it and the host that takes from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "host/base/bytes.hpp"

namespace gyrolog {

// Invariant: bytes leave in the order in which they came, and each flush ends the packet that holds the byte
// before it: a short packet, or an empty one (ZLP) when the last packet was full.
class InEndpoint {
public:
    explicit InEndpoint(std::size_t capacity_bytes) : capacity_bytes_(capacity_bytes) {}

    // How many bytes are held before write() refuses more: the endpoint's own packets, and what the host has
    // posted.
    void set_capacity(std::size_t capacity_bytes) { capacity_bytes_ = capacity_bytes; }

    // The firmware's side: returns how many bytes were accepted.
    std::size_t write(ByteView bytes);
    void flush();

    // The host's side: one transfer of buffer.size() bytes, a multiple of the packet. Nothing until it is
    // complete: ended by a short packet (0 bytes: a ZLP) or full. What it has so far stays here.
    std::optional<std::size_t> take_transfer(std::span<std::uint8_t> buffer);
    // The same bytes without their packets: whatever is there.
    std::size_t take_bytes(std::span<std::uint8_t> buffer);

    std::size_t pending_bytes() const { return bytes_.size() - begin_; }
    void clear();

private:
    std::size_t take(std::span<std::uint8_t> buffer, std::size_t size);

    std::size_t capacity_bytes_;
    Bytes bytes_;
    std::size_t begin_ = 0;
    std::uint64_t taken_ = 0;            // in all: the stream position of bytes_[begin_]
    std::uint64_t packet_start_ = 0;     // position behind the last flush: where packets are counted from
    std::deque<std::uint64_t> flushes_;  // positions not yet taken, in order
};

}  // namespace gyrolog
