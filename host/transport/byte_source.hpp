// The seam between devices and the rest: behind it USB, a tty, a replayed capture and the virtual board
// look alike.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

// A reader that is stopped for 2 s loses nothing; the rest is for its way back to work.
constexpr double stall_to_ride_out_s = 2.5;

// What is known of a device before its first frame. For a source that is not USB the identifiers are those of
// the board it stands for, or zero.
struct SourceIdentity {
    std::string uri;  // as the user may type it again: "usb:S1", "tty:/dev/ttyACM0", "sim:rate=1000,seed=7"
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::uint8_t bus_number = 0;
    std::uint8_t device_address = 0;
    std::string manufacturer;
    std::string product;
    std::string serial;
    Bytes device_descriptor;         // 18 bytes, empty when there is none
    Bytes configuration_descriptor;  // all of it, empty when there is none
};

enum class SourceEnd {
    stopped,      // stop() was called
    exhausted,    // a replayed file or a simulation of given length has no more
    device_lost,  // unplugged, or as good as
    failed,       // the error says what
};

// Receives what a source delivers. Calls come one at a time, from a thread of the source's own, and must not
// call stop(). on_end comes exactly once after start(), and is the last.
class TransferSink {
public:
    virtual ~TransferSink() = default;

    // False means "no room". A source that is paced by a device drops the transfer's data for good (the sink
    // has counted it); a source that can wait (can_wait()) tries again.
    virtual bool on_transfer(const Transfer& transfer) = 0;
    virtual void on_end(SourceEnd end, const std::optional<Error>& error) = 0;
};

// Order of calls: start, then write / set_line_state in any order, then stop. stop() returns after on_end.
// After start() the stream may begin at once on a device that was already streaming: set_line_state(false)
// quiets it. Everything is told to the sink: the stream, what was written, and a line state that was set (as
// SET_CONTROL_LINE_STATE), each at its place in the order.
class ByteSource {
public:
    virtual ~ByteSource() = default;

    virtual const SourceIdentity& identity() const = 0;
    virtual bool can_wait() const = 0;
    // The stall of the reader that the source rides out without losing a byte, at the given byte rate and
    // bytes per frame, each of which ends with a short packet; infinity for a source that can wait.
    virtual double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const = 0;
    // What the board says that it will send. A source that can queue more of it does, to ride out
    // stall_to_ride_out_s. After start(), at any time; nothing is lost by it.
    virtual void expect(double /*bytes_per_s*/, double /*bytes_per_frame*/) {}

    virtual Status start(TransferSink& sink) = 0;
    // Data terminal ready: the start signal (SPEC.md). Error `unsupported` on a line that has none (a pty):
    // the caller then uses the START and STOP commands.
    virtual Status set_line_state(bool data_terminal_ready) = 0;
    // Sends bytes to the device, all of them, within 1 s.
    virtual Status write(ByteView bytes) = 0;
    virtual void stop() = 0;
    // After stop(): gives the device back to the driver or program that had it before. Only reconnect() takes
    // it up again.
    virtual void let_go() {}
    // After a stop() that followed device_lost: gives up what is left of the device, and takes up the same
    // one, known by its serial number where it has one, if it is back. Then identity() is the present one's,
    // and start() may be called again. Errors: not_found, permission_denied or busy while another try may
    // succeed later; anything else: it will not come back.
    virtual Status reconnect() {
        return Error{ErrorCode::unsupported, identity().uri + ": what is lost does not come back"};
    }
};

}  // namespace gyrolog
