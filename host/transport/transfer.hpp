// One USB transfer, or what stands for it on a source that is not USB: the unit that a capture file stores.
#pragma once

#include <array>
#include <cstdint>

#include "host/base/bytes.hpp"
#include "host/base/clock.hpp"

namespace gyrolog {

enum class TransferKind : std::uint8_t { control = 2, bulk = 3 };  // numbered as usbmon does

// The endpoints by which the transfers of a line that is not USB are told.
constexpr std::uint8_t line_endpoint_in = 0x81;
constexpr std::uint8_t line_endpoint_out = 0x01;

// A transfer is told twice, as usbmon does: when it is submitted and when it completes, with the same id.
//   submission: requested_bytes; data of an OUT transfer; setup of a control transfer
//   completion: status; data of an IN transfer, which may come with an error status and is then still kept
// A view: `data` is valid only during the call that hands it over.
struct Transfer {
    enum class Event : std::uint8_t { submission = 'S', completion = 'C' };

    Event event = Event::completion;
    TransferKind kind = TransferKind::bulk;
    std::uint8_t endpoint = 0;  // with the direction bit 0x80
    std::uint64_t id = 0;       // pairs submission and completion; unique while in flight
    int status = 0;             // completion: 0 or a negative errno as the kernel's usb stack reports it
    std::uint32_t requested_bytes = 0;
    std::array<std::uint8_t, 8> setup{};
    HostTime time;
    ByteView data;

    bool carries_stream() const {
        return event == Event::completion && kind == TransferKind::bulk && (endpoint & 0x80U) != 0;
    }
};

}  // namespace gyrolog
