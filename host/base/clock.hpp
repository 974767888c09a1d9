// Host time. The monotonic clock orders and measures; the real-time clock only labels.
//
// Transfers are timed by CLOCK_BOOTTIME: the monotonic clock, but it does not stand still while the computer
// is suspended. A pause of a capture is then as long as it was.
#pragma once

#include <cstdint>

#include <time.h>

namespace gyrolog {

struct HostTime {
    std::int64_t monotonic_ns = 0;
    std::int64_t realtime_ns = 0;  // since the Unix epoch
};

inline std::int64_t clock_ns(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

inline HostTime host_now() { return {clock_ns(CLOCK_BOOTTIME), clock_ns(CLOCK_REALTIME)}; }

}  // namespace gyrolog
