#include "host/decode/sample_liveness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyrolog {
namespace {

// Inline, because most readings differ in their first byte.
bool same_reading(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) {
    return std::mismatch(a, a + size, b).first == a + size;
}

}  // namespace

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

// Most samples differ from the one before, and a stretch counts from frozen_samples repeats on: where the one
// that many places on is no repeat, those between need no look.
void SampleLiveness::take_samples(const glp_samples& samples, double rate_hz) {
    last_ticks_ = samples.first_ticks;
    silent_ticks_ = 0;
    samples_in_last_frame_ = samples.count;
    rate_hz_ = rate_hz;

    const std::size_t sample_bytes = glp_sample_bytes(samples.layout);
    const std::size_t count = samples.count;
    const auto at = [&](std::size_t i) { return samples.samples + i * sample_bytes; };
    std::size_t begin = 0;
    if (reading_.size() == sample_bytes) {
        while (begin < count && same_reading(at(begin), reading_.data(), sample_bytes)) { ++begin; }
    }
    repeats_ += begin;
    if (begin == count) { return; }
    if (frozen()) { frozen_before_ += repeats_; }
    const std::uint64_t step = std::max<std::uint64_t>(limits_.frozen_samples, 1);
    while (true) {
        const std::size_t looked_at = begin + std::min<std::uint64_t>(step, count - 1 - begin);
        std::size_t first = looked_at;
        while (first > begin && same_reading(at(first - 1), at(looked_at), sample_bytes)) { --first; }
        std::size_t end = looked_at + 1;
        while (end < count && same_reading(at(end), at(looked_at), sample_bytes)) { ++end; }
        repeats_ = end - 1 - first;
        if (end == count) { break; }
        if (frozen()) { frozen_before_ += repeats_; }
        begin = end;
    }
    reading_.assign(at(count - 1), at(count));
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

bool SampleLiveness::may_be_silent() const { return silent_s() > limits_.silence_s; }

std::uint64_t SampleLiveness::silent_instants(double rate_hz) const {
    const double instants = silent_s() * rate_hz;
    if (!may_be_silent() || instants <= limits_.silence_periods) { return 0; }
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
