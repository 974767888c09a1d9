// The host's side of a conformance run: says things to a device, waits for what comes, keeps the transcript.
//
// Time is that of the transfers: of the host for a real device, simulated for a virtual board that runs as
// fast as its data are taken. Such a board is held up while nothing waits for it, so that it does not run
// ahead.
//
// Threads: the source's thread writes the transcript under the lock. entries() and the like may be read
// without it only after stop().
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

#include "host/base/result.hpp"
#include "host/conform/transcript.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

class Probe final : private TransferSink {
public:
    // While it waits for anything, `go_on` is asked ten times a second. When it says no, that wait and all
    // later ones end as if their time were over, until finish() was called.
    Probe(ByteSource& source, const std::function<bool()>& go_on);
    ~Probe() override { stop(); }
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;

    Status start() { return source_.start(*this); }
    void stop();

    // Error `unsupported` on a line that has no DTR.
    Status set_line_state(bool raised);
    // Any bytes at all.
    Status write(ByteView bytes);
    // A command as a frame with both delimiters; its number goes up by one each time.
    Bytes command(unsigned type, ByteView payload);
    std::uint32_t take_number() { return ++number_; }
    std::uint32_t last_number() const { return number_; }

    // Waits until the REPLY to the command of this number is there. False: it did not come within 1 s.
    bool await_reply(std::uint32_t number);
    // Waits until the transcript grew by what `enough` asks for, at most `longest_s` by the host's clock
    // without a single byte, and at most `limit_s` of the transcript's own time.
    bool await(const std::function<bool(const Transcript&)>& enough, double longest_silence_s,
               double limit_s);
    // Takes all that comes until the line was silent for so long; at most `limit_s`. False: it never was.
    bool await_silence(double silence_s, double limit_s);
    // What is waited for from here on is waited for to the end.
    void finish();
    // Forgets what came so far.
    void forget();

    // The device went away, or the source failed.
    std::optional<Error> lost() const;
    bool ended() const;
    bool flooded() const;
    std::size_t entry_count() const;
    const Transcript& transcript() const { return transcript_; }
    // It runs on simulated time, and stands still while nothing waits for it.
    bool held_up() const { return held_up_; }

private:
    bool on_transfer(const Transfer& transfer) override;
    void on_end(SourceEnd end, const std::optional<Error>& error) override;
    bool given_up();

    ByteSource& source_;
    const std::function<bool()>& go_on_;
    const bool held_up_;
    bool wanted_ = true;
    bool finishing_ = false;
    std::uint32_t number_ = 0;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Transcript transcript_;
    bool listening_ = false;
    bool stopping_ = false;
    std::function<bool(const Transcript&)> enough_;
    std::uint64_t transfers_ = 0;
    bool ended_ = false;
    std::optional<Error> error_;
};

}  // namespace gyrolog
