// When the samples were taken: the board's ticks as seconds, the sensor's true rate, and the board's clock
// against the host's.
//
//   device time   unwrapped ticks / tick_hz, from the first sample of the capture; a boot of the board begins
//                 anew, and is placed behind the one before by the host's clock: by the smallest delays of
//                 the last frames there and of the first ones here, so that only the pause is measured by
//                 that clock
//   sensor rate   least squares of device time over sampling index, one intercept a run and one slope for all
//   host clock    host = offset + ratio * device. Delays only ever add, so the line is the lower envelope of
//                 the arrivals: the edge of their convex hull above their mean abscissa, which has the least
//                 sum of distances of all lines below every point (Zhang, Liu, Xia, "Clock Synchronization
//                 Algorithms for Network Measurements", INFOCOM 2002, section III)
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/clock.hpp"
#include "host/decode/link_accounts.hpp"
#include "host/decode/protocol.hpp"

namespace gyrolog {

// Sampling instants per second of the board's clock.
struct RateEstimate {
    double rate_hz = 0.0;
    double sd_hz = 0.0;     // one sigma; allows for residuals that are correlated from one stamp to the next
    double jitter_s = 0.0;  // one sigma of the stamps about the line
    std::size_t stamps = 0;
};

struct HostClockFit {
    double offset_s = 0.0;  // monotonic host time at device time 0, late by the smallest delay of the link
    double ratio = 1.0;     // host seconds per device second; far from 1 for a simulation that does not wait
    double offset_sd_s = 0.0;  // one sigma, from the scatter of the smallest delays of parts of the capture
    double ratio_sd = 0.0;
};

class SampleTimeline {
public:
    void take_hello(const glp_hello& hello);
    void take_samples(const SamplePlace& place, const glp_samples& samples, HostTime arrival);

    // Over runs first_run ... last_run, which must have one configuration. No value without three stamps or
    // tick_hz.
    std::optional<RateEstimate> rate(std::uint32_t first_run, std::uint32_t last_run) const;
    // Over the longest run.
    std::optional<HostClockFit> host_clock() const;

    // Device time of a sampling instant, which may be a lost one: from the nearest stamp, on at the given
    // rate. No value for a run that is not known, or without tick_hz.
    std::optional<double> device_time_s(std::uint32_t run, std::uint64_t index, double rate_hz) const;

    // From the first of the last samples until this boot of the board counts `ticks`. No value before there
    // are any, or without tick_hz.
    std::optional<double> since_last_s(std::uint32_t boot, std::uint64_t ticks, HostTime arrival) const;

    // Whether the first device time of a run is known for good, whatever comes.
    bool settled(std::uint32_t run) const;

    // Dropouts in order of arrival, with their device time. Where that is not known (no HELLO told the unit
    // of the stamps), the time is 0. `nominal_rate_hz` serves runs too short for a rate of their own.
    std::vector<Dropout> time_dropouts(const std::vector<LinkDropout>& dropouts,
                                       double nominal_rate_hz) const;

private:
    struct Stamp {
        std::int64_t index = 0;  // from the run's first
        std::int64_t ticks = 0;  // from the run's first sample
        std::int64_t arrival_ns = 0;
        std::int64_t last = 0;  // samples behind the first in the frame
    };
    struct Run {
        std::uint32_t boot = 0;
        std::uint32_t number = 0;
        std::uint64_t first_index = 0;
        std::int64_t start_ticks = 0;  // unwrapped, from the boot's first sample
        std::vector<Stamp> stamps;     // thinned to at most stamps_kept
        std::uint64_t stride = 1;      // frames per stamp kept
        std::uint64_t frames = 0;
        Stamp last;  // of its last frame
    };
    struct Boot {
        static constexpr std::size_t delays_kept = 32;

        std::uint32_t number = 0;
        std::int64_t arrival_ns = 0;  // of its first SAMPLES frame
        double base_s = 0.0;          // device time of that arrival, were all delays those of the boot before
        // From a frame's last sample, by this boot's ticks, to its arrival, beside the first frame's.
        double head_delay_s = 0.0;  // smallest of its first frames
        std::array<double, delays_kept> last_delays_s{};
        std::uint64_t frames = 0;

        double tail_delay_s() const;
    };

    std::int64_t ticks_since_last(std::uint64_t ticks, double about_ticks) const;
    double ticks_by_host(std::int64_t arrival_ns) const;
    double ticks_by_index(const SamplePlace& place, const glp_samples& samples,
                          std::int64_t arrival_ns) const;
    void keep(Run& run, const Stamp& stamp) const;
    void note_delay(Boot& boot, const Run& run) const;
    const Run* find(std::uint32_t number) const;
    // Device time of the first sample.
    double start_of(const Boot& boot) const;
    double start_of(const Run& run) const;

    std::vector<Boot> boots_;
    std::vector<Run> runs_;
    SamplePlace present_;  // kept or not
    std::optional<std::uint32_t> tick_hz_;
    std::uint64_t tick_mask_ = ~std::uint64_t{0};
    std::optional<std::uint64_t> raw_ticks_;  // at the last SAMPLES
    std::int64_t ticks_ = 0;                  // unwrapped, from the boot's first sample
    std::int64_t arrival_ns_ = 0;
};

}  // namespace gyrolog
