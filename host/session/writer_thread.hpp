// What a capture does with its transfers, in a thread of its own.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "host/base/clock.hpp"
#include "host/capture/segment_writer.hpp"
#include "host/decode/stream_decoder.hpp"
#include "host/session/capture_session.hpp"
#include "host/session/queueing_sink.hpp"
#include "host/session/transfer_queue.hpp"

namespace gyrolog {

// The writer's thread: drains the queue into the file and into the decoder, and tells the caller's thread
// what came.
//
// Promise to the user: a killed process loses at most what came in the last flush_interval and during the
// last two writes to the file. For each write takes all that came before it began (in pieces of a file's
// buffer), and the next one begins a flush_interval after its beginning, or at once where it took longer;
// syncs keep neither waiting. A change of files (rotation, --force) counts as part of the write before it: it
// waits for the disk.
class WriterThread final : private MessageHandler {
public:
    static constexpr std::chrono::milliseconds flush_interval{250};

    WriterThread(TransferQueue& queue, const QueueingSink& sink, SegmentWriter& writer,
                 const CaptureRequest& request)
        : queue_(queue),
          sink_(sink),
          writer_(writer),
          request_(request),
          decoder_({.keep_samples = false, .observer = this}),
          thread_([this] { run(); }) {}
    ~WriterThread() override { join(); }
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;

    // After the queue was closed: waits until everything in it is on disk.
    void join() {
        if (thread_.joinable()) { thread_.join(); }
    }

    // After join(), with the queue open again: what comes next comes over another connection.
    void resume();
    // Before the command is sent. Other replies are not kept: a device may send any number of them.
    void expect_reply(std::uint32_t sequence, std::uint8_t type);

    // What the caller's thread steers by. Only ever seen under the lock, or as a copy.
    struct State {
        bool line_was_raised = false;
        bool has_hello = false;  // in the present connection
        bool has_config = false;
        bool enough = false;
        // How long bytes have been coming that are no frames, by the times of their arrival.
        double frameless_s = 0.0;
        std::optional<Error> storage_error;
        std::optional<glp_reply> reply;  // to what expect_reply() named
    };
    State state() const;
    // Waits until `wanted(state)` holds or the time is over; the lock is held while it looks. Returns whether
    // it holds.
    template <typename Wanted>
    bool wait(std::chrono::milliseconds time, Wanted&& wanted) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, time, [&] { return wanted(std::as_const(state_)); });
    }

    // The same; gives up, too, when `go_on()` says so, which is asked ten times a second without the lock.
    template <typename Wanted>
    bool wait(std::chrono::milliseconds time, const std::function<bool()>& go_on, Wanted&& wanted) {
        constexpr std::chrono::milliseconds turn(100);
        for (; time.count() > 0; time -= turn) {
            if (wait(std::min(time, turn), wanted)) { return true; }
            if (!go_on()) { return false; }
        }
        return false;
    }

    CaptureProgress progress() const;
    LinkReport link() const { return decoder_.report(); }  // after join()

private:
    void run();
    std::chrono::milliseconds until_flush() const;
    void take(const Transfer& transfer);
    bool append_marks();
    void append_checkpoint();
    // What came until then, if it is due or wanted at once.
    void write_out(std::int64_t came_until_ns, bool at_once);
    void write_last();
    CaptureCounters counters() const;
    void fail(Error error);
    void publish();

    void on_hello(const ReceivedFrame& /*frame*/, const glp_hello& /*hello*/) override { hello_came_ = true; }
    void on_config(const ReceivedFrame& /*frame*/, const glp_config& /*config*/) override {
        config_came_ = true;
    }
    // By the stamps, unless they say what no sensor's clock is off by: an index or a tick has gone wrong
    // then.
    std::optional<double> plausible_rate_hz() const;

    void on_samples(const ReceivedFrame& received, const glp_samples& samples) override;
    void on_event(const ReceivedFrame& received, const glp_event& event) override;
    void on_status(const ReceivedFrame& received, const glp_device_status& status) override;
    void await_samples(std::int64_t from_ns);
    // By the times of arrival.
    double silent_s() const;
    bool enough(std::uint64_t instants, const std::optional<double>& rate_hz) const;
    bool enough_of_what_waits();
    void on_reply(const ReceivedFrame& /*frame*/, const glp_reply& reply) override;

    TransferQueue& queue_;
    const QueueingSink& sink_;
    SegmentWriter& writer_;
    const CaptureRequest& request_;

    // The writer thread's own.
    StreamDecoder decoder_;
    std::uint64_t bytes_since_checkpoint_ = 0;
    std::uint64_t marks_ = 0;
    std::int64_t last_sync_ns_ = clock_ns(CLOCK_MONOTONIC);
    std::int64_t last_flush_ns_ = clock_ns(CLOCK_MONOTONIC);  // its beginning
    bool started_ = false;                                    // by DTR, in the present connection
    bool any_start_ = false;
    bool hello_came_ = false;
    bool config_came_ = false;
    bool samples_came_ = false;  // in any connection
    std::optional<glp_samples> latest_;
    // Sampling instants that this capture covers, gaps within a run included. A sample's index alone would
    // not do: it counts from the board's start, and a board may have been streaming for hours before the
    // capture.
    std::uint64_t instants_ = 0;
    std::uint64_t instants_in_joins_ = 0;  // as published
    std::optional<double> rate_hz_;        // as published
    bool ended_ = false;                   // of a source that waits: what comes now is left
    std::optional<std::uint64_t> next_index_;
    std::int64_t last_samples_ns_ = 0;
    std::optional<std::int64_t> last_frame_ns_;
    std::int64_t last_data_ns_ = 0;
    std::optional<std::int64_t> awaited_from_ns_;  // the last samples, or the start; none while it is stopped
    std::optional<std::int64_t> first_awaited_ns_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    CaptureProgress progress_;
    State state_;
    glp_reply expected_{};

    std::thread thread_;  // last: starts when everything else is there
};

}  // namespace gyrolog
