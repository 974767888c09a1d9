// A device controller as the wires of a full-speed bus see it, one transaction at a time (USB 2.0, chapter
// 8).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "host/base/bytes.hpp"

namespace gyrolog {

constexpr std::size_t usb_packet_bytes = 64;

enum class Handshake {
    ack,
    nak,
    stall,
    none,  // nobody answers: not attached, another address, an endpoint that is off
};

struct UsbPacket {
    unsigned toggle = 0;
    std::array<std::uint8_t, usb_packet_bytes> bytes{};
    std::size_t size = 0;

    ByteView content() const { return ByteView(bytes).first(size); }
};

using UsbSetup = std::array<std::uint8_t, 8>;

class UsbDevice {
public:
    virtual ~UsbDevice() = default;

    virtual void plug(bool in) = 0;
    // The pull-up of D+.
    virtual bool attached() const = 0;
    virtual void bus_reset() = 0;
    // The bus falls idle, or wakes up.
    virtual void suspend(bool on) = 0;
    virtual void start_of_frame() = 0;

    virtual Handshake setup(unsigned address, const UsbSetup& request) = 0;
    virtual Handshake out(unsigned address, unsigned endpoint, const UsbPacket& packet) = 0;
    // Handshake::ack: `packet` is filled. Where `acknowledged` is false the host's own handshake is lost on
    // its way.
    virtual Handshake in(unsigned address, unsigned endpoint, UsbPacket& packet, bool acknowledged) = 0;
};

}  // namespace gyrolog
