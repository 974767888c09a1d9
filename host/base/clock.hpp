// Host time. The monotonic clock orders and measures; the real-time clock only labels.
//
// Transfers are timed by CLOCK_BOOTTIME: the monotonic clock, but it does not stand still while the computer
// is suspended. A pause of a capture is then as long as it was.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <time.h>

namespace gyrolog {

struct HostTime {
    std::int64_t monotonic_ns = 0;
    std::int64_t realtime_ns = 0;  // since the Unix epoch
};

// A time that a file tells, which may be damaged or made up, brought into half of its type's range (to the
// year 2116): any two of them differ by what the type holds.
inline constexpr std::int64_t told_ns_max = std::numeric_limits<std::int64_t>::max() / 2;
constexpr std::int64_t told_ns(std::int64_t time_ns) {
    return std::clamp(time_ns, -told_ns_max, told_ns_max);
}

inline std::int64_t clock_ns(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

inline HostTime host_now() { return {clock_ns(CLOCK_BOOTTIME), clock_ns(CLOCK_REALTIME)}; }

}  // namespace gyrolog
