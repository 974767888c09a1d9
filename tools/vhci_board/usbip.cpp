#include "tools/vhci_board/usbip.hpp"

#include <algorithm>
#include <string>

namespace gyrolog::usbip {
namespace {

enum CommandCode : std::uint32_t { cmd_submit = 1, cmd_unlink = 2, ret_submit = 3, ret_unlink = 4 };
constexpr std::uint32_t usbip_direction_in = 1;

// Offsets of the header's fields, in bytes.
constexpr std::size_t at_command = 0x00;
constexpr std::size_t at_sequence = 0x04;
constexpr std::size_t at_direction = 0x0C;
constexpr std::size_t at_endpoint = 0x10;
constexpr std::size_t at_requested_bytes = 0x18;
constexpr std::size_t at_setup = 0x28;
constexpr std::size_t at_unlink_target = 0x14;
constexpr std::size_t at_status = 0x14;
constexpr std::size_t at_actual_bytes = 0x18;

std::uint32_t load_u32(const Bytes& bytes, std::size_t at) {
    return (std::uint32_t{bytes[at]} << 24U) | (std::uint32_t{bytes[at + 1]} << 16U) |
           (std::uint32_t{bytes[at + 2]} << 8U) | std::uint32_t{bytes[at + 3]};
}

void store_u32(std::uint8_t* bytes, std::uint32_t value) {
    for (unsigned i = 0; i < 4; ++i) { bytes[i] = static_cast<std::uint8_t>(value >> (24U - 8U * i)); }
}

void append_reply(Bytes& out, CommandCode code, std::uint32_t sequence, int status,
                  std::uint32_t actual_bytes) {
    std::array<std::uint8_t, header_bytes> header{};
    store_u32(&header[at_command], code);
    store_u32(&header[at_sequence], sequence);
    store_u32(&header[at_status], static_cast<std::uint32_t>(status));
    store_u32(&header[at_actual_bytes], actual_bytes);
    out.insert(out.end(), header.begin(), header.end());
}

}  // namespace

Result<std::optional<Command>> CommandReader::next() {
    if (buffer_.size() < header_bytes) { return std::optional<Command>{}; }
    const std::uint32_t code = load_u32(buffer_, at_command);
    const std::uint32_t sequence = load_u32(buffer_, at_sequence);
    std::size_t command_bytes = header_bytes;
    Command command;
    if (code == cmd_unlink) {
        command = Unlink{sequence, load_u32(buffer_, at_unlink_target)};
    } else if (code == cmd_submit) {
        Submit submit;
        submit.sequence = sequence;
        submit.in = load_u32(buffer_, at_direction) == usbip_direction_in;
        submit.endpoint = static_cast<std::uint8_t>(load_u32(buffer_, at_endpoint) & 0x0FU);
        submit.requested_bytes = load_u32(buffer_, at_requested_bytes);
        if (submit.requested_bytes > transfer_bytes_max) {
            return Error{ErrorCode::malformed,
                         "usbip: transfer of " + std::to_string(submit.requested_bytes) + " bytes"};
        }
        if (!submit.in) { command_bytes += submit.requested_bytes; }
        if (buffer_.size() < command_bytes) { return std::optional<Command>{}; }
        std::copy_n(buffer_.begin() + at_setup, submit.setup.size(), submit.setup.begin());
        submit.data.assign(buffer_.begin() + header_bytes,
                           buffer_.begin() + static_cast<std::ptrdiff_t>(command_bytes));
        command = std::move(submit);
    } else {
        return Error{ErrorCode::malformed, "usbip: unknown command " + std::to_string(code)};
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(command_bytes));
    return std::optional<Command>{std::move(command)};
}

void append_submit_reply(Bytes& out, std::uint32_t sequence, int status, std::uint32_t actual_bytes,
                         ByteView data) {
    append_reply(out, ret_submit, sequence, status, actual_bytes);
    out.insert(out.end(), data.begin(), data.end());
}

void append_unlink_reply(Bytes& out, std::uint32_t sequence, int status) {
    append_reply(out, ret_unlink, sequence, status, 0);
}

}  // namespace gyrolog::usbip
