// The blocks of pcapng that a capture is made of (draft-ietf-opsawg-pcapng; FORMAT.md says which of them, and
// how). Little endian only: a section of the other byte order is not read.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "host/base/bytes.hpp"

namespace gyrolog::pcapng {

constexpr std::uint32_t section_header = 0x0A0D0D0A;
constexpr std::uint32_t interface_description = 1;
constexpr std::uint32_t interface_statistics = 5;
constexpr std::uint32_t enhanced_packet = 6;

constexpr std::uint32_t byte_order_magic = 0x1A2B3C4D;
constexpr std::size_t block_bytes_min = 12;
// Longer than any block of a USB capture, whose packets end at 256 KiB. A length beyond it is taken for
// damage.
constexpr std::size_t block_bytes_max = std::size_t{1} << 20U;
constexpr std::size_t packet_bytes_max = 262'144;

constexpr std::uint16_t option_comment = 1;
constexpr std::uint16_t option_name = 2;  // of an interface; in a section header: hardware
constexpr std::uint16_t option_packet_hash = 3;
constexpr std::uint16_t option_application = 4;  // of a section header; in statistics: packets received
constexpr std::uint16_t option_dropped = 5;      // of statistics
constexpr std::uint16_t option_time_resolution = 9;

struct Option {
    std::uint16_t code = 0;
    ByteView value;
};

// The options that stand in `bytes`. No value when they overrun them.
std::optional<std::vector<Option>> read_options(ByteView bytes);

// Each appends one whole block to `out`.
//
// A text whose bytes are vouched for: the comment is followed by a second one with its checksum (FORMAT.md,
// rule 3.2).
void append_section_header(Bytes& out, std::string_view comment, std::string_view application);
void append_interface(Bytes& out, std::uint32_t link_type, std::string_view name);
void append_statistics(Bytes& out, std::int64_t time_ns, std::string_view comment, std::uint64_t received,
                       std::uint64_t dropped);
// Appends the packet, which `write_packet(out)` writes, with its hash.
template <typename WritePacket>
void append_packet(Bytes& out, std::int64_t time_ns, WritePacket&& write_packet);

// The comment that append_ was given, if its checksum agrees. `block` is a whole block of its kind.
std::optional<std::string_view> section_comment(ByteView block);
std::optional<std::string_view> statistics_comment(ByteView block);

struct Packet {
    std::uint32_t interface = 0;
    std::uint64_t time = 0;  // in the interface's resolution
    ByteView bytes;
    std::uint32_t original_bytes = 0;
    enum class Hash : std::uint8_t { absent, right, wrong } hash = Hash::absent;
};

// `block` is a whole enhanced packet block. No value when its fields overrun it.
std::optional<Packet> read_packet(ByteView block);

// The parts of append_packet that do not depend on who writes the packet.
std::size_t begin_packet(Bytes& out, std::int64_t time_ns);
void end_packet(Bytes& out, std::size_t begin);

template <typename WritePacket>
void append_packet(Bytes& out, std::int64_t time_ns, WritePacket&& write_packet) {
    const std::size_t begin = begin_packet(out, time_ns);
    write_packet(out);
    end_packet(out, begin);
}

}  // namespace gyrolog::pcapng
