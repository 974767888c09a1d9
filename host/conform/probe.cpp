#include "host/conform/probe.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include <gyrolog_protocol/frame.h>

namespace gyrolog {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds asking_interval(100);
constexpr double reply_timeout_s = 1.0;
// A virtual board answers at once, when this computer lets it.
constexpr double held_up_timeout_s = 3.0;
constexpr double held_up_limit_s = 3.0;  // what had been sent before is taken first: up to 1 s

std::chrono::nanoseconds to_ns(double duration_s) {
    return std::chrono::nanoseconds(static_cast<std::int64_t>(duration_s * 1e9));
}

}  // namespace

// A source that can wait but keeps to the clock would lose what nobody takes.
Probe::Probe(ByteSource& source, const std::function<bool()>& go_on)
    : source_(source),
      go_on_(go_on),
      held_up_(source.can_wait() && std::isinf(source.tolerated_stall_s(1.0, 1.0))) {}

void Probe::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    source_.stop();
}

Status Probe::set_line_state(bool raised) { return source_.set_line_state(raised); }

Status Probe::write(ByteView bytes) { return source_.write(bytes); }

Bytes Probe::command(unsigned type, ByteView payload) {
    const glp_frame frame{static_cast<std::uint8_t>(type), 0, ++number_, payload.data(), payload.size()};
    Bytes wire(GLP_FRAME_WIRE_MAX);
    wire.resize(glp_frame_encode(&frame, wire.data(), wire.size()).size);
    return wire;
}

bool Probe::await_reply(std::uint32_t number) {
    std::size_t looked_at = 0;
    bool found = false;
    const auto has_reply = [&](const Transcript& transcript) {
        const auto& entries = transcript.entries();
        for (; looked_at < entries.size() && !found; ++looked_at) {
            const auto reply = reply_in(entries[looked_at]);
            found = reply && reply->command_sequence == number;
        }
        return found;
    };
    // A stream that goes on is no answer: the limit is by the clock of both.
    return await(has_reply, held_up_ ? held_up_timeout_s : reply_timeout_s,
                 held_up_ ? held_up_limit_s : reply_timeout_s);
}

bool Probe::await(const std::function<bool(const Transcript&)>& enough, double longest_silence_s,
                  double limit_s) {
    std::unique_lock lock(mutex_);
    if (enough(transcript_)) { return true; }
    const double begin_s = transcript_.now_s();
    const auto begin = Clock::now();
    enough_ = enough;
    listening_ = true;
    bool satisfied = false;
    while (!satisfied) {
        const std::uint64_t transfers = transfers_;
        const auto silent_until = Clock::now() + to_ns(longest_silence_s);
        bool moved = false;
        while (!moved && Clock::now() < silent_until && !given_up()) {
            moved = changed_.wait_until(
                lock, std::min<Clock::time_point>(silent_until, Clock::now() + asking_interval),
                [&] { return transfers_ != transfers || ended_ || !listening_; });
        }
        satisfied = !listening_ || enough(transcript_);
        const bool over =
            transcript_.now_s() - begin_s >= limit_s || (!held_up_ && Clock::now() - begin >= to_ns(limit_s));
        if (!moved || ended_ || over || transcript_.full() || given_up()) { break; }
    }
    listening_ = false;
    enough_ = nullptr;
    return satisfied;
}

bool Probe::await_silence(double silence_s, double limit_s) {
    std::uint64_t before = 0;
    std::optional<double> begin_s;
    const auto begin = Clock::now();
    while (true) {
        {
            const std::lock_guard lock(mutex_);
            before = transcript_.bytes_received();
            if (!begin_s) { begin_s = transcript_.now_s(); }
            if (ended_ || transcript_.full()) { return false; }
        }
        const bool spoke = await([&](const Transcript& now) { return now.bytes_received() != before; },
                                 silence_s, silence_s);
        if (!spoke) { return true; }
        const std::lock_guard lock(mutex_);
        if (Clock::now() - begin >= to_ns(limit_s) || transcript_.now_s() - *begin_s >= limit_s) {
            return false;
        }
    }
}

bool Probe::given_up() {
    wanted_ = wanted_ && go_on_();
    return !wanted_ && !finishing_;
}

void Probe::finish() {
    const std::lock_guard lock(mutex_);
    finishing_ = true;
}

void Probe::forget() {
    const std::lock_guard lock(mutex_);
    transcript_.begin_here();
}

std::optional<Error> Probe::lost() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

bool Probe::ended() const {
    const std::lock_guard lock(mutex_);
    return ended_;
}

bool Probe::flooded() const {
    const std::lock_guard lock(mutex_);
    return transcript_.full();
}

std::size_t Probe::entry_count() const {
    const std::lock_guard lock(mutex_);
    return transcript_.entries().size();
}

bool Probe::on_transfer(const Transfer& transfer) {
    const std::lock_guard lock(mutex_);
    const bool stream = transfer.carries_stream() && !transfer.data.empty();
    if (stream && held_up_ && !listening_) { return stopping_; }
    transcript_.take(transfer);
    if (!stream) { return true; }
    ++transfers_;
    if (listening_ && enough_ && enough_(transcript_)) { listening_ = false; }
    changed_.notify_all();
    return true;
}

void Probe::on_end(SourceEnd /*end*/, const std::optional<Error>& error) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    error_ = error;
    changed_.notify_all();
}

}  // namespace gyrolog
