// Keeps a board in step with the host's clock, however late and seldom the program is woken.
#pragma once

#include <algorithm>
#include <cstdint>

#include "host/base/clock.hpp"
#include "host/virtual_board/usb_function.hpp"

namespace gyrolog {

class BoardPace {
public:
    // Runs the board up to now and calls `after_step` on the way so often that the board's ring need not run
    // over while the host has transfers posted: a host controller would have taken the bytes as they came.
    template <typename AfterStep>
    void catch_up(UsbFunction& board, AfterStep&& after_step) {
        const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
        while (last_ns_ < now_ns) {
            last_ns_ = last_ns_ == 0 ? now_ns : std::min(now_ns, last_ns_ + step_ns);
            board.advance_to(last_ns_);
            after_step();
        }
    }

private:
    // At 32 kHz and 14 bytes a sample the board makes 2.3 kB in this time; its ring holds 4 KiB.
    static constexpr std::int64_t step_ns = 5'000'000;

    std::int64_t last_ns_ = 0;  // host time that the board has reached
};

}  // namespace gyrolog
