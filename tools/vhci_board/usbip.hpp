// USB/IP as vhci_hcd speaks it once a device is attached: the kernel sends URBs to carry out, the device
// answers each. Source: Linux kernel documentation, "USB/IP protocol". Every message is a header of 48 bytes
// in network byte order and, for data that travel, the data. Isochronous transfers are left out: the board
// has none.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog::usbip {

constexpr std::size_t header_bytes = 48;
// Longer transfers than this are refused as malformed; usbfs itself submits no more at once.
constexpr std::uint32_t transfer_bytes_max = 1U << 20U;

// USBIP_CMD_SUBMIT: carry out one URB.
struct Submit {
    std::uint32_t sequence = 0;
    bool in = false;
    std::uint8_t endpoint = 0;  // without the direction bit
    std::uint32_t requested_bytes = 0;
    std::array<std::uint8_t, 8> setup{};  // of a control transfer
    Bytes data;                           // of an OUT transfer, requested_bytes of them
};

// USBIP_CMD_UNLINK: give up the URB of sequence number `target`.
struct Unlink {
    std::uint32_t sequence = 0;
    std::uint32_t target = 0;
};

using Command = std::variant<Submit, Unlink>;

// Takes commands off a byte stream, however it is cut.
class CommandReader {
public:
    void append(ByteView bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }

    // The next whole command, or nothing until more bytes come. Error `malformed`: a command that is not
    // known or a transfer that is too long; the stream cannot be followed any further.
    Result<std::optional<Command>> next();

private:
    Bytes buffer_;
};

// USBIP_RET_SUBMIT. `status` is 0 or a negative errno; `actual_bytes` is what was moved; `data` follows for
// an IN transfer and is then actual_bytes long.
void append_submit_reply(Bytes& out, std::uint32_t sequence, int status, std::uint32_t actual_bytes,
                         ByteView data);

// USBIP_RET_UNLINK. -ECONNRESET when the URB was given up, 0 when its reply had already gone out.
void append_unlink_reply(Bytes& out, std::uint32_t sequence, int status);

}  // namespace gyrolog::usbip
