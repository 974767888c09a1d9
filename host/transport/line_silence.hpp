// Waits until a line has fallen silent, after DTR was lowered (SPEC.md, 9.5).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "host/base/clock.hpp"

namespace gyrolog {

class LineSilence {
public:
    static constexpr std::int64_t silence_ns = 50'000'000;
    // A board that talks on all the same is not waited for any longer.
    static constexpr std::int64_t longest_ns = 1'000'000'000;

    // Data came; from any thread.
    void heard() { heard_ns_ = clock_ns(CLOCK_MONOTONIC); }

    // `sleep(ns)` returns early, and true, when the stream has ended meanwhile.
    template <typename Sleep>
    void await(Sleep&& sleep) const {
        const std::int64_t begin_ns = clock_ns(CLOCK_MONOTONIC);
        while (true) {
            const std::int64_t silent_from_ns = std::max(begin_ns, heard_ns_.load());
            const std::int64_t until_ns = std::min(silent_from_ns + silence_ns, begin_ns + longest_ns);
            const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
            if (now_ns >= until_ns || sleep(until_ns - now_ns)) { return; }
        }
    }

private:
    std::atomic<std::int64_t> heard_ns_{0};
};

}  // namespace gyrolog
