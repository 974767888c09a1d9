// Whether a board that says it streams also samples. Frames can be intact and numbered without a gap while no
// sample comes, or while one reading comes again and again: the accounts of the link see neither.
//
// Time is the board's own, told by STATUS, EVENT and SAMPLES frames, which may not be further apart than one
// round of its tick counter.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/decode/protocol.hpp"

namespace gyrolog {

struct LivenessLimits {
    double silence_s = 2.0;             // without a sample
    double silence_periods = 8.0;       // of the sampling rate, where that is longer
    double frozen_s = 2.0;              // with one reading
    std::uint64_t frozen_samples = 50;  // noise below one count may repeat a few
};

class SampleLiveness {
public:
    explicit SampleLiveness(LivenessLimits limits = {}) : limits_(limits) {}

    // The clock that comes next has nothing to do with the one before: another boot, another connection.
    void begin_clock();
    void take_hello(const glp_hello& hello);
    void take_samples(const glp_samples& samples, double rate_hz);
    void take_status(const glp_device_status& status);
    void take_event(const glp_event& event);

    // Board's time from the last sample or the start up to the stop, or as last told.
    double silent_s() const;
    // Longer than the limit that holds at any rate.
    bool may_be_silent() const;
    // Sampling instants since then, once there are more than the limit allows; 0 before.
    std::uint64_t silent_instants(double rate_hz) const;
    // Samples in stretches of one reading that are longer than the limits.
    std::uint64_t frozen_samples() const;
    // Length of the present stretch of one reading; 0 below the limits.
    double frozen_now_s() const;

private:
    void tick(std::uint64_t ticks);
    bool frozen() const;

    LivenessLimits limits_;
    std::optional<std::uint32_t> tick_hz_;
    std::uint64_t tick_mask_ = ~std::uint64_t{0};
    std::optional<std::uint64_t> last_ticks_;  // while it streams
    std::uint64_t silent_ticks_ = 0;
    std::uint64_t samples_in_last_frame_ = 0;

    std::vector<std::uint8_t> reading_;
    std::uint64_t repeats_ = 0;
    double rate_hz_ = 0.0;
    std::uint64_t frozen_before_ = 0;
};

}  // namespace gyrolog
