#include "host/decode/sample_liveness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyrolog {

void SampleLiveness::begin_clock() {
    last_ticks_.reset();
    silent_ticks_ = 0;
    samples_in_last_frame_ = 0;
}

void SampleLiveness::take_hello(const glp_hello& hello) {
    tick_hz_ = hello.tick_hz;
    tick_mask_ = hello.tick_bits >= 64 ? std::numeric_limits<std::uint64_t>::max()
                                       : (std::uint64_t{1} << hello.tick_bits) - 1;
}

void SampleLiveness::tick(std::uint64_t ticks) {
    if (last_ticks_) {
        const std::uint64_t passed = (ticks - *last_ticks_) & tick_mask_;
        // A stamp that was taken before the last one, and sent after it.
        if (passed > tick_mask_ / 2) { return; }
        silent_ticks_ += passed;
    }
    last_ticks_ = ticks;
}

void SampleLiveness::take_samples(const glp_samples& samples, double rate_hz) {
    last_ticks_ = samples.first_ticks;
    silent_ticks_ = 0;
    samples_in_last_frame_ = samples.count;
    rate_hz_ = rate_hz;
    const std::size_t sample_bytes = glp_sample_bytes(samples.layout);
    for (std::size_t i = 0; i < samples.count; ++i) {
        const std::uint8_t* sample = samples.samples + i * sample_bytes;
        if (std::equal(sample, sample + sample_bytes, reading_.begin(), reading_.end())) {
            ++repeats_;
            continue;
        }
        if (frozen()) { frozen_before_ += repeats_; }
        reading_.assign(sample, sample + sample_bytes);
        repeats_ = 0;
    }
}

void SampleLiveness::take_status(const glp_device_status& status) {
    if (status.streaming != 0) {
        tick(status.ticks);
    } else {
        last_ticks_.reset();
    }
}

void SampleLiveness::take_event(const glp_event& event) {
    if (event.code == glp_event_started) { begin_clock(); }
    tick(event.ticks);
    if (event.code == glp_event_stopped) { last_ticks_.reset(); }
}

double SampleLiveness::silent_s() const {
    return tick_hz_ ? static_cast<double>(silent_ticks_) / *tick_hz_ : 0.0;
}

std::uint64_t SampleLiveness::silent_instants(double rate_hz) const {
    const double instants = silent_s() * rate_hz;
    if (silent_s() <= limits_.silence_s || instants <= limits_.silence_periods) { return 0; }
    constexpr double most = 1e15;
    const auto passed = static_cast<std::uint64_t>(std::min(instants, most));
    return passed - std::min(passed, samples_in_last_frame_);
}

bool SampleLiveness::frozen() const {
    return repeats_ >= limits_.frozen_samples && rate_hz_ > 0.0 &&
           static_cast<double>(repeats_) / rate_hz_ > limits_.frozen_s;
}

std::uint64_t SampleLiveness::frozen_samples() const { return frozen_before_ + (frozen() ? repeats_ : 0); }

double SampleLiveness::frozen_now_s() const {
    return frozen() ? static_cast<double>(repeats_) / rate_hz_ : 0.0;
}

}  // namespace gyrolog
