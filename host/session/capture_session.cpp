#include "host/session/capture_session.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "host/capture/capture_writer.hpp"
#include "host/session/transfer_queue.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds progress_interval(100);
constexpr milliseconds reply_timeout(1000);
constexpr milliseconds flush_time(150);  // for the partial frame that a board sends when it is stopped
constexpr std::int64_t sync_interval_ns = 1'000'000'000;
constexpr std::uint64_t checkpoint_bytes = std::uint64_t{1} << 20U;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// The source's thread hands transfers over here; what finds no room is counted.
class QueueingSink final : public TransferSink {
public:
    QueueingSink(TransferQueue& queue, bool source_waits) : queue_(queue), source_waits_(source_waits) {}

    bool on_transfer(const Transfer& transfer) override {
        if (transfer.carries_stream() && !transfer.data.empty()) {
            last_data_ns_.store(clock_ns(CLOCK_MONOTONIC), std::memory_order_relaxed);
        }
        if (queue_.push(transfer)) { return true; }
        if (!source_waits_) {
            ++transfers_dropped_;
            bytes_dropped_ += transfer.data.size();
        }
        return false;
    }

    void on_end(SourceEnd end, const std::optional<Error>& error) override {
        {
            const std::lock_guard lock(mutex_);
            end_ = end;
            error_ = error;
        }
        queue_.close();
    }

    // No value while the source runs.
    std::optional<SourceEnd> end() const {
        const std::lock_guard lock(mutex_);
        return end_;
    }
    std::optional<Error> error() const {
        const std::lock_guard lock(mutex_);
        return error_;
    }
    double silence_s() const {
        return static_cast<double>(clock_ns(CLOCK_MONOTONIC) -
                                   last_data_ns_.load(std::memory_order_relaxed)) *
               1e-9;
    }
    void restart_silence() { last_data_ns_.store(clock_ns(CLOCK_MONOTONIC)); }
    std::uint64_t transfers_dropped() const { return transfers_dropped_; }
    std::uint64_t bytes_dropped() const { return bytes_dropped_; }

private:
    TransferQueue& queue_;
    const bool source_waits_;
    std::atomic<std::int64_t> last_data_ns_{clock_ns(CLOCK_MONOTONIC)};
    std::atomic<std::uint64_t> transfers_dropped_{0};
    std::atomic<std::uint64_t> bytes_dropped_{0};
    mutable std::mutex mutex_;
    std::optional<SourceEnd> end_;
    std::optional<Error> error_;
};

// The writer's thread: drains the queue into the file and into the decoder, and tells the caller's thread
// what came.
class WriterThread final : private MessageHandler {
public:
    WriterThread(TransferQueue& queue, const QueueingSink& sink, CaptureWriter& writer,
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

    // Before the command is sent. Other replies are not kept: a device may send any number of them.
    void expect_reply(std::uint32_t sequence, std::uint8_t type) {
        const std::lock_guard lock(mutex_);
        expected_ = {sequence, type, 0};
        reply_.reset();
    }

    // Waits until `wanted(*this)` holds or the time is over; the lock is held while it looks.
    template <typename Wanted>
    bool wait(milliseconds time, Wanted&& wanted) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, time, [&] { return wanted(); });
    }
    // The ones below: inside wait(), or after join().
    bool line_was_raised() const { return line_was_raised_; }
    bool has_hello() const { return progress_.hello.has_value(); }
    bool has_config() const { return progress_.config.has_value(); }
    bool enough() const { return enough_; }
    const std::optional<Error>& storage_error() const { return storage_error_; }
    const std::optional<glp_reply>& reply() const { return reply_; }  // to what expect_reply() named
    // How long bytes have been coming that are no frames, by the times of their arrival.
    double frameless_s() const { return frameless_s_; }

    CaptureProgress progress() const {
        const std::lock_guard lock(mutex_);
        return progress_;
    }
    LinkReport link() const { return decoder_.report(); }  // after join()

private:
    void run() {
        while (!queue_.finished()) {
            queue_.pop(progress_interval).for_each([&](const Transfer& transfer) { take(transfer); });
            if (clock_ns(CLOCK_MONOTONIC) - last_sync_ns_ >= sync_interval_ns) { checkpoint(false); }
            publish();
        }
        checkpoint(true);
        publish();
    }

    void take(const Transfer& transfer) {
        if (!storage_error_) {
            if (Status appended = writer_.append(transfer); !appended.ok()) {
                fail(std::move(appended).error());
            }
        }
        if (transfer.carries_stream()) { bytes_since_checkpoint_ += transfer.data.size(); }
        const std::uint64_t frames_before = decoder_.intact_frames();
        const bool begins_anew = decoder_.take(transfer);
        if (decoder_.intact_frames() != frames_before || begins_anew) {
            last_frame_ns_ = transfer.time.monotonic_ns;
        }
        if (transfer.carries_stream() && !transfer.data.empty()) {
            last_data_ns_ = transfer.time.monotonic_ns;
        }
        if (begins_anew) {
            started_ = true;
            instants_ = 0;
            next_index_.reset();
            latest_.reset();
        }
        if (bytes_since_checkpoint_ >= checkpoint_bytes) { checkpoint(false); }
    }

    void checkpoint(bool last) {
        const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
        const bool sync_due = last || now_ns - last_sync_ns_ >= sync_interval_ns;
        bytes_since_checkpoint_ = 0;
        if (storage_error_) { return; }
        Status written = writer_.checkpoint(counters());
        if (written.ok() && sync_due) { written = writer_.sync(); }
        if (sync_due) { last_sync_ns_ = now_ns; }
        if (!written.ok()) { fail(std::move(written).error()); }
    }

    CaptureCounters counters() const {
        const LinkReport link = decoder_.report();
        return {.stream_bytes = link.bytes.total,
                .frames = link.frames.good,
                .samples = link.samples.good,
                .frames_missing = link.frames.missing,
                .samples_missing = link.samples.missing,
                .transfers_dropped = sink_.transfers_dropped(),
                .bytes_dropped = sink_.bytes_dropped()};
    }

    void fail(Error error) {
        const std::lock_guard lock(mutex_);
        storage_error_ = std::move(error);
    }

    void publish() {
        const LinkReport link = decoder_.report();
        const std::lock_guard lock(mutex_);
        progress_.samples = link.samples.good;
        progress_.samples_missing = link.samples.missing;
        progress_.dropouts = link.dropouts.size() + link.dropouts_unlisted;
        progress_.frames_corrupted = link.frames.corrupted;
        progress_.file_bytes = writer_.bytes_written();
        progress_.rate_hz = plausible_rate_hz();
        progress_.hello = decoder_.hello();
        progress_.config = decoder_.config();
        if (latest_ && progress_.config) {
            progress_.temperature_C = progress_.config->temp_offset_mC * 1e-3 +
                                      latest_->temperature * 1e-9 * progress_.config->temp_nC_per_lsb;
        }
        if (progress_.rate_hz) { progress_.device_s = static_cast<double>(instants_) / *progress_.rate_hz; }
        line_was_raised_ = started_;
        if (last_frame_ns_) { frameless_s_ = static_cast<double>(last_data_ns_ - *last_frame_ns_) * 1e-9; }
        enough_ = (request_.samples && instants_ >= *request_.samples) ||
                  (request_.duration_s && progress_.rate_hz &&
                   static_cast<double>(instants_) >= *request_.duration_s * *progress_.rate_hz);
        changed_.notify_all();
    }

    // By the stamps, unless they say what no sensor's clock is off by: an index or a tick has gone wrong
    // then.
    std::optional<double> plausible_rate_hz() const {
        const std::optional<double> rate_hz = decoder_.rate_hz();
        if (!rate_hz || !decoder_.config()) { return rate_hz; }
        const double nominal_hz = decoder_.config()->rate_mHz * 1e-3;
        return std::fabs(*rate_hz / nominal_hz - 1.0) <= clock_error_max ? *rate_hz : nominal_hz;
    }

    void on_samples(const ReceivedFrame& received, const glp_samples& samples) override {
        latest_ = samples;
        latest_->samples = nullptr;
        const bool first = (received.frame.flags & glp_flag_first_after_start) != 0;
        const bool goes_on = next_index_ && !first && samples.first_index >= *next_index_;
        const std::uint64_t gap = goes_on ? samples.first_index - *next_index_ : 0;
        // A gap that no board can have passed since its last samples is an index gone wrong, not time.
        const double since_s = static_cast<double>(received.arrival.monotonic_ns - last_samples_ns_) * 1e-9;
        instants_ += samples.count + (static_cast<double>(gap) <= fastest_hz * (since_s + slack_s) ? gap : 0);
        next_index_ = samples.first_index + samples.count;
        last_samples_ns_ = received.arrival.monotonic_ns;
    }
    void on_reply(const ReceivedFrame& /*frame*/, const glp_reply& reply) override {
        const std::lock_guard lock(mutex_);
        if (reply.command_sequence == expected_.command_sequence &&
            reply.command_type == expected_.command_type) {
            reply_ = reply;
        }
    }

    static constexpr double fastest_hz = 33'000.0;  // of an MPU-9250, with its clock's error
    static constexpr double clock_error_max = 0.25;
    static constexpr double slack_s = 10.0;  // of what had waited on its way

    TransferQueue& queue_;
    const QueueingSink& sink_;
    CaptureWriter& writer_;
    const CaptureRequest& request_;

    // The writer thread's own.
    StreamDecoder decoder_;
    std::uint64_t bytes_since_checkpoint_ = 0;
    std::int64_t last_sync_ns_ = clock_ns(CLOCK_MONOTONIC);
    bool started_ = false;  // by DTR
    std::optional<glp_samples> latest_;
    // Sampling instants that this capture covers, gaps within a run included. A sample's index alone would
    // not do: it counts from the board's start, and a board may have been streaming for hours before the
    // capture.
    std::uint64_t instants_ = 0;
    std::optional<std::uint64_t> next_index_;
    std::int64_t last_samples_ns_ = 0;
    std::optional<std::int64_t> last_frame_ns_;
    std::int64_t last_data_ns_ = 0;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    CaptureProgress progress_;
    glp_reply expected_{};
    std::optional<glp_reply> reply_;
    double frameless_s_ = 0.0;
    std::optional<Error> storage_error_;
    bool enough_ = false;
    bool line_was_raised_ = false;

    std::thread thread_;  // last: starts when everything else is there
};

// The conversation with the board: quiet, configured, started; and stopped again at the end. A line without
// control signals (a pty, a bare UART) is started and stopped by commands instead. A source that takes
// neither (a replayed capture) plays whatever it has.
class BoardControl {
public:
    BoardControl(ByteSource& source, WriterThread& writer, const QueueingSink& sink)
        : source_(source), writer_(writer), sink_(sink) {}

    Status quiet() {
        Status lowered = source_.set_line_state(false);
        if (lowered.ok()) { return {}; }
        if (lowered.error().code != ErrorCode::unsupported) { return lowered; }
        has_line_ = false;
        const Status stopped = command(glp_frame_stop, {}, Answer::awaited);
        if (!stopped.ok() && stopped.error().code == ErrorCode::unsupported) {
            takes_commands_ = false;
            return {};
        }
        // A board that was quiet already, or is still booting, may leave this one unanswered.
        return stopped.ok() || stopped.error().code == ErrorCode::timeout ? Status() : stopped;
    }

    Status configure(const glp_configure& wanted) {
        const bool asked = wanted.rate_mHz != 0 || wanted.dlpf_hz != 0 || wanted.gyro_full_scale_dps != 0 ||
                           wanted.accel_full_scale_g != 0 || wanted.layout != 0 ||
                           wanted.samples_per_frame != 0;
        if (!asked) { return {}; }
        if (!takes_commands_) {
            return Error{
                ErrorCode::invalid_argument,
                source_.identity().uri + " cannot be configured: leave --rate, --full-scale and --dlpf out"};
        }
        std::array<std::uint8_t, GLP_FRAME_PAYLOAD_MAX> payload{};
        const std::size_t size = glp_configure_write(&wanted, payload.data(), payload.size());
        return command(glp_frame_configure, ByteView(payload).first(size), Answer::awaited);
    }

    bool has_line() const { return has_line_; }

    Status start() {
        start_asked_ = true;
        if (has_line_) { return source_.set_line_state(true); }
        if (!takes_commands_) { return {}; }
        GYROLOG_CHECK(command(glp_frame_start, {}, Answer::awaited));
        return command(glp_frame_get_hello, {}, Answer::not_awaited);
    }

    // Quiets a board that was asked to start. Whatever goes wrong here, the capture is over anyway.
    void stop() {
        if (!start_asked_) { return; }
        if (has_line_) {
            static_cast<void>(source_.set_line_state(false));
        } else if (takes_commands_) {
            static_cast<void>(command(glp_frame_stop, {}, Answer::not_awaited));
        }
        if (!source_.can_wait()) { std::this_thread::sleep_for(flush_time); }
    }

private:
    enum class Answer { awaited, not_awaited };

    Status command(glp_frame_type type, ByteView payload, Answer answer) {
        const glp_frame frame{static_cast<std::uint8_t>(type), 0, ++sequence_, payload.data(),
                              payload.size()};
        std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
        const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
        writer_.expect_reply(sequence_, frame.type);
        GYROLOG_CHECK(source_.write(ByteView(wire).first(encoded.size)));
        if (answer == Answer::not_awaited) { return {}; }
        std::optional<std::uint8_t> result;
        writer_.wait(reply_timeout, [&] {
            if (writer_.reply()) { result = writer_.reply()->result; }
            return result.has_value() || sink_.end().has_value();
        });
        if (!result) {
            if (const auto error = sink_.error()) { return *error; }
            return Error{ErrorCode::timeout,
                         "the board on " + source_.identity().uri + " did not answer a command"};
        }
        return refusal(*result);
    }

    Status refusal(std::uint8_t result) const {
        switch (result) {
            case glp_result_ok:
                return {};
            case glp_result_bad_value:
                return Error{ErrorCode::invalid_argument, "the board on " + source_.identity().uri +
                                                              " does not have this rate, full scale or "
                                                              "low-pass (an MPU-9250 has 4 Hz to 1000 Hz in "
                                                              "whole divisions of 1 kHz, or 8000 Hz; 250, "
                                                              "500, 1000 or 2000 °/s; 5, 10, 20, 41, 92, "
                                                              "184, 250 or 3600 Hz or off)"};
            case glp_result_sensor_fault:
                return Error{ErrorCode::failed,
                             "the board on " + source_.identity().uri + " cannot talk to its sensor"};
            default:
                return Error{ErrorCode::unsupported,
                             fmt::format("the board on {} refused a command (result {})",
                                         source_.identity().uri, result)};
        }
    }

    ByteSource& source_;
    WriterThread& writer_;
    const QueueingSink& sink_;
    bool has_line_ = true;
    bool takes_commands_ = true;
    bool start_asked_ = false;
    std::uint32_t sequence_ = 0;
};

constexpr const char* no_hello = "no HELLO and CONFIG frame";

// A file that cannot be made is no missing device.
Error storage_error_of(Error error) {
    if (error.code == ErrorCode::not_found || error.code == ErrorCode::permission_denied) {
        error.code = ErrorCode::storage_failed;
    }
    return error;
}

// From a silent board to a stream whose HELLO and CONFIG have come.
Status begin(ByteSource& source, QueueingSink& sink, WriterThread& writer, BoardControl& control,
             const CaptureRequest& request) {
    GYROLOG_CHECK(source.start(sink));
    GYROLOG_CHECK(control.quiet());
    GYROLOG_CHECK(control.configure(request.configure));
    GYROLOG_CHECK(control.start());
    // A HELLO from before the start may be that of a stream which somebody else had started.
    const auto identified = [&] {
        return (writer.line_was_raised() || !control.has_line()) && writer.has_hello() && writer.has_config();
    };
    writer.wait(milliseconds(static_cast<std::int64_t>(request.hello_timeout_s * 1e3)),
                [&] { return identified() || sink.end().has_value(); });
    // The source may have ended with the frames still in the queue.
    if (sink.end()) { writer.join(); }
    if (identified()) { return {}; }
    if (const auto error = sink.error()) { return *error; }
    return Error{ErrorCode::timeout, no_hello};
}

// What the bytes that did come say about a board that did not identify itself.
Error explain(const Error& error, const ByteSource& source, const LinkReport& link) {
    if (error.message != no_hello) { return error; }
    const std::string& uri = source.identity().uri;
    if (link.bytes.total == 0) { return {ErrorCode::timeout, uri + ": nothing came after the start"}; }
    if (link.frames.corrupted_by_reason[glp_status_bad_version] > 0) {
        return {ErrorCode::unsupported,
                fmt::format(
                    "{} speaks another major version of the protocol than {}: update gyrolog or the firmware",
                    uri, GLP_PROTOCOL_MAJOR)};
    }
    return {ErrorCode::malformed,
            fmt::format(
                "{}: {} bytes came, but no HELLO and CONFIG frame: this is no gyrolog board, or not its data "
                "port",
                uri, link.bytes.total)};
}

// Runs until there is enough, the caller or the source ends it, or the disk refuses.
CaptureEnd stream_until_end(const ByteSource& source, WriterThread& writer, QueueingSink& sink,
                            const CaptureRequest& request, const CaptureObserver& observe,
                            std::optional<Error>& error) {
    sink.restart_silence();
    const auto start = Clock::now();
    while (true) {
        bool enough = false;
        bool refused = false;
        bool frameless = false;
        writer.wait(progress_interval, [&] {
            enough = writer.enough();
            refused = writer.storage_error().has_value();
            // An old capture may hold any amount of noise; a device that is there may not.
            frameless = !source.can_wait() && writer.frameless_s() > request.idle_timeout_s;
            return enough || refused || frameless || sink.end().has_value();
        });
        CaptureProgress progress = writer.progress();
        progress.elapsed_s = seconds_since(start);
        const bool go_on = observe(progress);
        if (refused) { return CaptureEnd::storage_failed; }
        if (enough) { return CaptureEnd::complete; }
        if (const auto end = sink.end()) {
            error = sink.error();
            if (*end == SourceEnd::exhausted || *end == SourceEnd::stopped) { return CaptureEnd::complete; }
            return CaptureEnd::device_lost;
        }
        if (!go_on) { return CaptureEnd::interrupted; }
        if (frameless) {
            error = Error{
                ErrorCode::device_lost,
                fmt::format("{}: for {:g} s only bytes came that are no frames; `gyrolog conform` shows them",
                            source.identity().uri, request.idle_timeout_s)};
            return CaptureEnd::device_lost;
        }
        if (sink.silence_s() > request.idle_timeout_s) {
            error = Error{ErrorCode::device_lost, fmt::format("{}: silent for {:g} s", source.identity().uri,
                                                              request.idle_timeout_s)};
            return CaptureEnd::device_lost;
        }
    }
}

}  // namespace

Result<CaptureOutcome> run_capture(ByteSource& source, const CaptureRequest& request,
                                   const CaptureObserver& observe) {
    auto created = CaptureWriter::create(request.path, source.identity(), request.overwrite);
    if (!created.ok()) { return storage_error_of(std::move(created).error()); }
    CaptureWriter writer = std::move(created).value();
    TransferQueue queue(request.queue_bytes);
    QueueingSink sink(queue, source.can_wait());
    WriterThread thread(queue, sink, writer, request);
    BoardControl control(source, thread, sink);

    CaptureOutcome outcome;
    const Status began = begin(source, sink, thread, control, request);
    if (began.ok()) { outcome.end = stream_until_end(source, thread, sink, request, observe, outcome.error); }
    control.stop();
    // Tear-down, in this order: the source (its last callback closes the queue), the queue, the writer, the
    // file.
    source.stop();
    queue.close();
    thread.join();
    Status closed = writer.close();
    if (thread.storage_error()) { closed = *thread.storage_error(); }
    outcome.link = thread.link();
    if (!began.ok()) {
        if (outcome.link.bytes.total == 0) { static_cast<void>(std::remove(request.path.c_str())); }
        return closed.ok() ? explain(began.error(), source, outcome.link) : closed.error();
    }
    if (!closed.ok()) {
        outcome.end = CaptureEnd::storage_failed;
        outcome.error = closed.error();
    }
    outcome.progress = thread.progress();
    outcome.transfers_dropped = sink.transfers_dropped();
    outcome.bytes_dropped = sink.bytes_dropped();
    outcome.queue_high_water_bytes = queue.high_water_bytes();
    return outcome;
}

}  // namespace gyrolog
