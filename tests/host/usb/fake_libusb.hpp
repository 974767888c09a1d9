// libusb's transfer calls as a test wants them: defined here, the linker takes these instead of the
// library's.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <libusb.h>

#include "tests/support/umockdev_board.hpp"

namespace gyrolog::test {

struct FakeCompletion {
    libusb_transfer_status status = LIBUSB_TRANSFER_COMPLETED;
    int received_bytes = 0;  // filled with a running count, modulo 256
};

// The bus and the kernel behind it. Judges the caller by libusb's rules: a transfer is not submitted twice,
// not freed while in flight, and every one that was allocated is freed; a device is closed as often as it was
// opened, with nothing in flight unless events have failed.
//
// Unlike umockdev it needs no preloaded library, so that ThreadSanitizer sees all that host/usb does.
class FakeUsb {
public:
    // What happens to the oldest transfer in flight; nothing while the board is silent. The argument counts
    // the completions so far. Asked on the event thread.
    using Script = std::function<std::optional<FakeCompletion>(std::uint64_t)>;
    // What submitting yields; the argument counts the submissions tried so far.
    using Admission = std::function<int(std::uint64_t)>;

    static FakeUsb& bus();

    void reset(Script script, Admission admission = {});
    // A device on bus 1 that answers in the script's place; none with null. The one before is gone, and what
    // was in flight fails with NO_DEVICE.
    void plug_in(MockUsbFunction* function, std::uint8_t device_address = 2);
    // From now on event handling fails with this code; with LIBUSB_SUCCESS it works again. So many times only
    // where `times` is given.
    static constexpr std::uint64_t for_good = ~std::uint64_t{0};
    void fail_events(int code, std::uint64_t times = for_good);
    // Nothing completes any more but what is cancelled.
    void fall_silent();
    // Cancelled transfers complete only after this many further turns of event handling.
    void delay_cancellations(unsigned turns);
    // From now on, as after a disconnect, everything fails with NO_DEVICE.
    void unplug();
    void answer_clear_halt(int code);

    std::uint64_t completions() const;
    std::uint64_t clear_halts() const;
    std::uint64_t event_turns() const;
    std::size_t most_in_flight() const;
    // Breaches of libusb's rules, and transfers never freed.
    std::vector<std::string> complaints() const;
};

}  // namespace gyrolog::test
