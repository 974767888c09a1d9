// The virtual board as a USB device, whatever carries the requests: an emulated usbfs, the kernel's vhci_hcd.
//
// One thread at a time. Time is the host's monotonic clock, handed in: the board runs as a real one would.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "host/base/bytes.hpp"
#include "host/virtual_board/virtual_board.hpp"

namespace gyrolog {

class UsbFunction {
public:
    struct ControlResponse {
        bool stall = false;
        Bytes data;  // of an IN request, never longer than wLength
    };

    explicit UsbFunction(VirtualBoard& board);

    // Lets the board run up to this moment. The first call sets the origin.
    void advance_to(std::int64_t host_monotonic_ns);

    // One request on endpoint 0. `out_data`: the data stage of an OUT request.
    ControlResponse control(const std::array<std::uint8_t, 8>& setup, ByteView out_data);

    // A bulk IN transfer into `buffer`, whose size is a multiple of 64. Nothing means NAK: ask again later,
    // with the same size. Otherwise the transfer is complete with so many bytes, 0 for a zero-length packet.
    // The host's buffer counts as posted from the first ask until it is complete: that much the board may
    // send ahead.
    std::optional<std::size_t> bulk_in(std::span<std::uint8_t> buffer);
    void bulk_out(ByteView data);

    const UsbEndpoints& endpoints() const { return board_.endpoints(); }
    // The device has left the bus: every transfer is now to fail.
    bool unplugged() const { return board_.unplugged(); }
    // The bus was reset or the cable pulled: the device falls back to its unconfigured state.
    void bus_reset();

private:
    ControlResponse standard_request(const std::array<std::uint8_t, 8>& setup);
    ControlResponse class_request(const std::array<std::uint8_t, 8>& setup, ByteView out_data);

    VirtualBoard& board_;
    std::optional<std::int64_t> origin_ns_;  // host time of board time 0
    std::uint8_t configuration_ = 0;
    // 115200 baud, one stop bit, no parity, 8 data bits: kept and told back, of no effect.
    std::array<std::uint8_t, 7> line_coding_ = {0x00, 0xC2, 0x01, 0x00, 0, 0, 8};
};

}  // namespace gyrolog
