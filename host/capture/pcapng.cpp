#include "host/capture/pcapng.hpp"

#include <charconv>
#include <string>

extern "C" {
#include <gyrolog_protocol/crc.h>
}

#include "host/capture/byte_order.hpp"

namespace gyrolog::pcapng {
namespace {

constexpr std::string_view checksum_prefix = "gyrolog-crc32:";
constexpr std::uint8_t hash_crc32 = 2;
constexpr std::size_t section_options_offset = 24;
constexpr std::size_t statistics_options_offset = 20;
constexpr std::size_t packet_header_bytes = 28;  // of the block, up to the packet
constexpr std::uint16_t option_end = 0;
constexpr std::uint16_t option_received = 4;
constexpr std::uint8_t nanoseconds = 9;

std::size_t padded(std::size_t size) { return (size + 3U) & ~std::size_t{3}; }

void pad(Bytes& out, std::size_t begin) { out.resize(begin + padded(out.size() - begin)); }

void put_at(Bytes& out, std::size_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) { out[offset + i] = static_cast<std::uint8_t>(value >> (8U * i)); }
}

std::size_t begin_block(Bytes& out, std::uint32_t type) {
    const std::size_t begin = out.size();
    put<std::uint32_t>(out, type);
    put<std::uint32_t>(out, 0);
    return begin;
}

void end_block(Bytes& out, std::size_t begin) {
    const auto length = static_cast<std::uint32_t>(out.size() - begin + 4U);
    put<std::uint32_t>(out, length);
    put_at(out, begin + 4, length);
}

void append_option(Bytes& out, std::uint16_t code, ByteView value) {
    put<std::uint16_t>(out, code);
    put<std::uint16_t>(out, static_cast<std::uint16_t>(value.size()));
    const std::size_t begin = out.size();
    out.insert(out.end(), value.begin(), value.end());
    pad(out, begin);
}

void append_number(Bytes& out, std::uint16_t code, std::uint64_t number) {
    Bytes bytes;
    put<std::uint64_t>(bytes, number);
    append_option(out, code, bytes);
}

void append_end(Bytes& out) {
    put<std::uint16_t>(out, option_end);
    put<std::uint16_t>(out, 0);
}

void put_time(Bytes& out, std::int64_t time_ns) {
    const auto time = static_cast<std::uint64_t>(time_ns);
    put<std::uint32_t>(out, static_cast<std::uint32_t>(time >> 32U));
    put<std::uint32_t>(out, static_cast<std::uint32_t>(time));
}

std::string checksum_text(ByteView bytes) {
    std::array<char, 8> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(),
                                       glp_crc32(bytes.data(), bytes.size()), 16);
    const auto count = static_cast<std::size_t>(written.ptr - digits.data());
    return std::string(checksum_prefix) + std::string(8 - count, '0') + std::string(digits.data(), count);
}

void append_checked_comment(Bytes& out, std::string_view comment) {
    append_option(out, option_comment, as_bytes(comment));
    append_option(out, option_comment, as_bytes(checksum_text(as_bytes(comment))));
}

std::optional<std::string_view> checked_comment(ByteView block, std::size_t options_offset) {
    if (block.size() < options_offset + 4) { return std::nullopt; }
    const auto options = read_options(block.subspan(options_offset, block.size() - options_offset - 4));
    for (std::size_t i = 0; options && i + 1 < options->size(); ++i) {
        const Option& comment = (*options)[i];
        const Option& checksum = (*options)[i + 1];
        if (comment.code == option_comment && checksum.code == option_comment &&
            as_text(checksum.value) == checksum_text(comment.value)) {
            return as_text(comment.value);
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::vector<Option>> read_options(ByteView bytes) {
    std::vector<Option> options;
    while (bytes.size() >= 4) {
        const auto code = get<std::uint16_t>(bytes, 0);
        const std::size_t size = get<std::uint16_t>(bytes, 2);
        if (code == option_end) { return options; }
        if (4 + padded(size) > bytes.size()) { return std::nullopt; }
        options.push_back({code, bytes.subspan(4, size)});
        bytes = bytes.subspan(4 + padded(size));
    }
    return options;
}

std::optional<std::string_view> section_comment(ByteView block) {
    return checked_comment(block, section_options_offset);
}

std::optional<std::string_view> statistics_comment(ByteView block) {
    return checked_comment(block, statistics_options_offset);
}

void append_section_header(Bytes& out, std::string_view comment, std::string_view application) {
    const std::size_t begin = begin_block(out, section_header);
    put<std::uint32_t>(out, byte_order_magic);
    put<std::uint16_t>(out, 1);
    put<std::uint16_t>(out, 0);
    put<std::int64_t>(out, -1);  // the section's length is not known in advance
    append_checked_comment(out, comment);
    append_option(out, option_application, as_bytes(application));
    append_end(out);
    end_block(out, begin);
}

void append_interface(Bytes& out, std::uint32_t link_type, std::string_view name) {
    const std::size_t begin = begin_block(out, interface_description);
    put<std::uint16_t>(out, static_cast<std::uint16_t>(link_type));
    put<std::uint16_t>(out, 0);
    put<std::uint32_t>(out, packet_bytes_max);
    append_option(out, option_name, as_bytes(name));
    append_option(out, option_time_resolution, ByteView(&nanoseconds, 1));
    append_end(out);
    end_block(out, begin);
}

void append_statistics(Bytes& out, std::int64_t time_ns, std::string_view comment, std::uint64_t received,
                       std::uint64_t dropped) {
    const std::size_t begin = begin_block(out, interface_statistics);
    put<std::uint32_t>(out, 0);
    put_time(out, time_ns);
    append_checked_comment(out, comment);
    append_number(out, option_received, received);
    append_number(out, option_dropped, dropped);
    append_end(out);
    end_block(out, begin);
}

std::size_t begin_packet(Bytes& out, std::int64_t time_ns) {
    const std::size_t begin = begin_block(out, enhanced_packet);
    put<std::uint32_t>(out, 0);
    put_time(out, time_ns);
    put<std::uint64_t>(out, 0);
    return begin;
}

void end_packet(Bytes& out, std::size_t begin) {
    const std::size_t packet = begin + packet_header_bytes;
    const auto size = static_cast<std::uint32_t>(out.size() - packet);
    put_at(out, begin + 20, size);
    put_at(out, begin + 24, size);
    const std::uint32_t crc = glp_crc32(out.data() + packet, size);
    pad(out, packet);
    const std::array<std::uint8_t, 5> hash{
        hash_crc32, static_cast<std::uint8_t>(crc >> 24U), static_cast<std::uint8_t>(crc >> 16U),
        static_cast<std::uint8_t>(crc >> 8U), static_cast<std::uint8_t>(crc)};
    append_option(out, option_packet_hash, hash);
    append_end(out);
    end_block(out, begin);
}

std::optional<Packet> read_packet(ByteView block) {
    if (block.size() < packet_header_bytes + 4) { return std::nullopt; }
    const ByteView body = block.subspan(packet_header_bytes, block.size() - packet_header_bytes - 4);
    const std::size_t size = get<std::uint32_t>(block, 20);
    if (padded(size) > body.size()) { return std::nullopt; }

    Packet packet;
    packet.interface = get<std::uint32_t>(block, 8);
    packet.time = (std::uint64_t{get<std::uint32_t>(block, 12)} << 32U) | get<std::uint32_t>(block, 16);
    packet.bytes = body.first(size);
    packet.original_bytes = get<std::uint32_t>(block, 24);
    ByteView options = body.subspan(padded(size));
    while (options.size() >= 4) {
        const auto code = get<std::uint16_t>(options, 0);
        const std::size_t value_bytes = get<std::uint16_t>(options, 2);
        if (code == option_end) { break; }
        if (4 + padded(value_bytes) > options.size()) { return std::nullopt; }
        const ByteView value = options.subspan(4, value_bytes);
        if (code == option_packet_hash && value.size() == 5 && value[0] == hash_crc32) {
            const std::uint32_t told = (std::uint32_t{value[1]} << 24U) | (std::uint32_t{value[2]} << 16U) |
                                       (std::uint32_t{value[3]} << 8U) | value[4];
            packet.hash =
                told == glp_crc32(packet.bytes.data(), size) ? Packet::Hash::right : Packet::Hash::wrong;
        }
        options = options.subspan(4 + padded(value_bytes));
    }
    return packet;
}

}  // namespace gyrolog::pcapng
