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

#include "host/capture/segment_writer.hpp"
#include "host/session/transfer_queue.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds progress_interval(100);
constexpr milliseconds reply_timeout(1000);
constexpr milliseconds flush_time(150);  // for the partial frame that a board sends when it is stopped
constexpr std::int64_t sync_interval_ns = 1'000'000'000;
constexpr std::size_t queue_bytes_of_patient_source = std::size_t{2} << 20U;
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
            data_transfers_.fetch_add(1, std::memory_order_relaxed);
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

    void reopen() {
        const std::lock_guard lock(mutex_);
        end_.reset();
        error_.reset();
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
    std::uint64_t data_transfers() const { return data_transfers_.load(std::memory_order_relaxed); }
    std::uint64_t transfers_dropped() const { return transfers_dropped_; }
    std::uint64_t bytes_dropped() const { return bytes_dropped_; }

private:
    TransferQueue& queue_;
    const bool source_waits_;
    std::atomic<std::uint64_t> data_transfers_{0};
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
    void resume() {
        decoder_.begin_connection();
        started_ = false;
        hello_came_ = false;
        config_came_ = false;
        next_index_.reset();
        last_frame_ns_.reset();
        frameless_s_ = 0.0;
        publish();
        thread_ = std::thread([this] { run(); });
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
    bool has_hello() const { return has_hello_; }  // in the present connection
    bool has_config() const { return has_config_; }
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
        if (request_.observer != nullptr) { request_.observer->on_decoder(decoder_); }
        while (!queue_.finished()) {
            queue_.pop(progress_interval).for_each([&](const Transfer& transfer) { take(transfer); });
            write_marks();
            if (clock_ns(CLOCK_MONOTONIC) - last_sync_ns_ >= sync_interval_ns) { checkpoint(false); }
            publish();
        }
        write_marks();
        checkpoint(true);
        publish();
    }

    void write_marks() {
        if (request_.control == nullptr) { return; }
        for (CaptureMark& mark : request_.control->take_marks()) {
            if (storage_error_) { return; }
            if (Status written = writer_.mark(std::move(mark)); !written.ok()) {
                fail(std::move(written).error());
            } else {
                ++marks_;
            }
        }
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
            hello_came_ = false;
            config_came_ = false;
            if (!any_start_) {
                instants_ = 0;
                if (request_.observer != nullptr) { request_.observer->on_start(); }
            }
            any_start_ = true;
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
        if (written.ok() && sync_due) { written = last ? writer_.sync() : writer_.sync_soon(); }
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
        progress_.path = writer_.paths().back();
        progress_.marks = marks_;
        progress_.rate_hz = plausible_rate_hz();
        progress_.hello = decoder_.hello();
        progress_.config = decoder_.config();
        if (latest_ && progress_.config) {
            progress_.temperature_C = progress_.config->temp_offset_mC * 1e-3 +
                                      latest_->temperature * 1e-9 * progress_.config->temp_nC_per_lsb;
        }
        const std::uint64_t instants = instants_ + link.samples_in_joins;
        if (progress_.rate_hz) { progress_.device_s = static_cast<double>(instants) / *progress_.rate_hz; }
        line_was_raised_ = started_;
        has_hello_ = hello_came_;
        has_config_ = config_came_;
        if (last_frame_ns_) { frameless_s_ = static_cast<double>(last_data_ns_ - *last_frame_ns_) * 1e-9; }
        enough_ = (request_.samples && instants >= *request_.samples) ||
                  (request_.duration_s && progress_.rate_hz &&
                   static_cast<double>(instants) >= *request_.duration_s * *progress_.rate_hz);
        changed_.notify_all();
    }

    void on_hello(const ReceivedFrame& /*frame*/, const glp_hello& /*hello*/) override { hello_came_ = true; }
    void on_config(const ReceivedFrame& /*frame*/, const glp_config& /*config*/) override {
        config_came_ = true;
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
        if (request_.observer != nullptr && decoder_.config()) {
            request_.observer->on_samples(received.frame, samples, *decoder_.config());
        }
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
    SegmentWriter& writer_;
    const CaptureRequest& request_;

    // The writer thread's own.
    StreamDecoder decoder_;
    std::uint64_t bytes_since_checkpoint_ = 0;
    std::uint64_t marks_ = 0;
    std::int64_t last_sync_ns_ = clock_ns(CLOCK_MONOTONIC);
    bool started_ = false;  // by DTR, in the present connection
    bool any_start_ = false;
    bool hello_came_ = false;
    bool config_came_ = false;
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
    bool has_hello_ = false;
    bool has_config_ = false;

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
        streaming_ = true;
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

    // As the user asks in the middle of a capture. A source that takes neither line nor commands goes on.
    Status set_streaming(bool wanted) {
        if (wanted == streaming_ || !(has_line_ || takes_commands_)) { return {}; }
        streaming_ = wanted;
        if (wanted) { return start(); }
        stop();
        return {};
    }
    bool streaming() const { return streaming_; }

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
    bool streaming_ = true;
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
             const glp_configure& configure, const CaptureRequest& request) {
    GYROLOG_CHECK(source.start(sink));
    GYROLOG_CHECK(control.quiet());
    GYROLOG_CHECK(control.configure(configure));
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

// A board may have lost its memory with its power: it is set up again as it last said that it was.
glp_configure configuration_of(const glp_config& config) {
    glp_configure wanted{};
    wanted.rate_mHz = config.rate_mHz;
    wanted.gyro_full_scale_dps = config.gyro_full_scale_dps;
    wanted.accel_full_scale_g = config.accel_full_scale_g;
    wanted.dlpf_hz = config.dlpf_hz == 0 ? std::uint16_t{GLP_DLPF_OFF} : config.dlpf_hz;
    wanted.layout = config.layout;
    wanted.samples_per_frame = config.samples_per_frame;
    return wanted;
}

// A full SAMPLES frame on the wire: header, payload and checksum, stuffed, and its delimiters.
double wire_bytes(const glp_config& config) {
    constexpr double header_and_checksum = 12.0;
    constexpr double payload_before_samples = 28.0;
    const double body = header_and_checksum + payload_before_samples +
                        static_cast<double>(config.samples_per_frame * glp_sample_bytes(config.layout));
    return body + 1.0 + std::floor(body / 254.0) + 1.0;
}

// How long a board has said nothing while somebody listened. A program that stood still itself has not
// listened.
class Silence {
public:
    void begin() {
        silent_ = Clock::duration::zero();
        last_look_ = Clock::now();
    }
    double seconds(std::uint64_t data_transfers) {
        constexpr std::chrono::seconds longest_listening(1);
        const auto now = Clock::now();
        silent_ = data_transfers != heard_
                      ? Clock::duration::zero()
                      : silent_ + std::min<Clock::duration>(now - last_look_, longest_listening);
        heard_ = data_transfers;
        last_look_ = now;
        return std::chrono::duration<double>(silent_).count();
    }

private:
    std::uint64_t heard_ = 0;
    Clock::duration silent_{};
    Clock::time_point last_look_ = Clock::now();
};

// Whether another try may succeed once the board is back, or wide awake.
bool may_come_back(ErrorCode code) {
    switch (code) {
        case ErrorCode::not_found:
        case ErrorCode::permission_denied:
        case ErrorCode::busy:
        case ErrorCode::timeout:
        case ErrorCode::device_lost:
        case ErrorCode::malformed:
        case ErrorCode::failed:
            return true;
        default:
            return false;
    }
}

class Session {
public:
    Session(ByteSource& source, const CaptureRequest& request, const CaptureObserver& observe,
            SegmentWriter& writer)
        : source_(source),
          request_(request),
          observe_(observe),
          writer_(writer),
          // A source that can wait fills whatever room there is, and loses nothing where there is little.
          queue_(source.can_wait() ? std::min(request.queue_bytes, queue_bytes_of_patient_source)
                                   : request.queue_bytes),
          sink_(queue_, source.can_wait()),
          thread_(queue_, sink_, writer, request),
          control_(source, thread_, sink_) {}

    Result<CaptureOutcome> run() {
        const Status began = begin(source_, sink_, thread_, control_, request_.configure, request_);
        if (began.ok()) {
            settle_queue();
            stream_until_end();
            while (outcome_.end == CaptureEnd::device_lost && request_.on_unplug == OnUnplug::wait &&
                   park()) {
                stream_until_end();
            }
        }
        control_.stop();
        wind_up();
        Status closed = thread_.storage_error() ? Status(*thread_.storage_error()) : Status();
        outcome_.link = thread_.link();
        if (!began.ok() && outcome_.link.bytes.total == 0) { writer_.drop(); }
        const Status last = writer_.close();
        if (closed.ok()) { closed = last; }
        if (!began.ok()) {
            return closed.ok() ? explain(began.error(), source_, outcome_.link) : closed.error();
        }
        if (!closed.ok()) {
            outcome_.end = CaptureEnd::storage_failed;
            outcome_.error = closed.error();
        }
        outcome_.progress = thread_.progress();
        outcome_.progress.file_bytes = writer_.bytes_written();
        outcome_.progress.connections = connections_;
        outcome_.paths = writer_.paths();
        outcome_.transfers_dropped = sink_.transfers_dropped();
        outcome_.bytes_dropped = sink_.bytes_dropped();
        outcome_.queue_high_water_bytes = queue_.high_water_bytes();
        return std::move(outcome_);
    }

private:
    // In this order: the source (its last callback closes the queue), the queue, the writer.
    void wind_up() {
        source_.stop();
        queue_.close();
        thread_.join();
    }

    // The board has said what it will send.
    void settle_queue() {
        const std::optional<glp_config> config = thread_.progress().config;
        if (!config || config->samples_per_frame == 0) { return; }
        const double bytes_per_frame = wire_bytes(*config);
        const double bytes_per_s = bytes_per_frame * config->rate_mHz * 1e-3 / config->samples_per_frame;
        source_.expect(bytes_per_s, bytes_per_frame);
        tolerated_stall_s_ = source_.tolerated_stall_s(bytes_per_s, bytes_per_frame);
    }

    CaptureProgress progress() const {
        CaptureProgress progress = thread_.progress();
        progress.tolerated_stall_s = tolerated_stall_s_;
        progress.elapsed_s = seconds_since(start_);
        progress.connections = connections_;
        progress.streaming = control_.streaming();
        return progress;
    }

    // Runs until there is enough, the caller or the source ends it, or the disk refuses.
    void stream_until_end() {
        silence_.begin();
        outcome_.error.reset();
        while (true) {
            bool enough = false;
            bool refused = false;
            bool frameless = false;
            thread_.wait(progress_interval, [&] {
                enough = thread_.enough();
                refused = thread_.storage_error().has_value();
                // An old capture may hold any amount of noise; a device that is there may not.
                frameless = !source_.can_wait() && thread_.frameless_s() > request_.idle_timeout_s;
                return enough || refused || frameless || sink_.end().has_value();
            });
            const bool go_on = observe_(progress());
            if (refused) { return end(CaptureEnd::storage_failed); }
            if (enough) { return end(CaptureEnd::complete); }
            if (const auto ended = sink_.end()) {
                outcome_.error = sink_.error();
                const bool done = *ended == SourceEnd::exhausted || *ended == SourceEnd::stopped;
                return end(done ? CaptureEnd::complete : CaptureEnd::device_lost);
            }
            if (!go_on) { return end(CaptureEnd::interrupted); }
            if (frameless) {
                outcome_.error = Error{
                    ErrorCode::device_lost,
                    fmt::format(
                        "{}: for {:g} s only bytes came that are no frames; `gyrolog conform` shows them",
                        source_.identity().uri, request_.idle_timeout_s)};
                return end(CaptureEnd::device_lost);
            }
            if (Status obeyed = obey(); !obeyed.ok()) {
                outcome_.error = std::move(obeyed).error();
                return end(CaptureEnd::device_lost);
            }
            if (silence_.seconds(sink_.data_transfers()) > request_.idle_timeout_s) {
                outcome_.error = Error{
                    ErrorCode::device_lost,
                    fmt::format("{}: silent for {:g} s", source_.identity().uri, request_.idle_timeout_s)};
                return end(CaptureEnd::device_lost);
            }
        }
    }
    void end(CaptureEnd how) { outcome_.end = how; }

    Status obey() {
        if (request_.control == nullptr) { return {}; }
        GYROLOG_CHECK(control_.set_streaming(request_.control->streaming_wanted()));
        if (!control_.streaming()) { silence_.begin(); }
        return {};
    }

    // True when the board streams again. Otherwise the outcome stays that of a lost device, or is a disk that
    // refused the next file.
    bool park() {
        wind_up();
        if (thread_.storage_error()) { return false; }
        if (Status closed = writer_.close(); !closed.ok()) {
            return storage_failed(std::move(closed).error());
        }
        const auto lost_at = Clock::now();
        std::string why = outcome_.error ? outcome_.error->message : source_.identity().uri + ": lost";
        auto next_try = lost_at;
        while (true) {
            CaptureProgress parked = progress();
            parked.parked = true;
            parked.parked_s = seconds_since(lost_at);
            parked.parked_why = why;
            if (!observe_(parked) || over(parked)) { return false; }
            if (Clock::now() < next_try) {
                std::this_thread::sleep_for(
                    std::min<Clock::duration>(progress_interval, next_try - Clock::now()));
                continue;
            }
            Status back = source_.reconnect();
            if (back.ok()) { back = resume(); }
            if (back.ok()) { return true; }
            if (outcome_.end == CaptureEnd::storage_failed) { return false; }
            if (!may_come_back(back.error().code)) {
                // A source that cannot come back at all has nothing to add to how it was lost.
                if (back.error().code != ErrorCode::unsupported) { outcome_.error = std::move(back).error(); }
                return false;
            }
            why = back.error().message;
            next_try = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(request_.reconnect_interval_s));
        }
    }

    // The next file, and the handshake with a board that is back.
    Status resume() {
        ++connections_;
        if (Status opened = writer_.begin_connection(source_.identity()); !opened.ok()) {
            storage_failed(storage_error_of(std::move(opened).error()));
            return *outcome_.error;
        }
        const CaptureProgress before = thread_.progress();
        const glp_configure again = before.config ? configuration_of(*before.config) : request_.configure;
        const std::uint64_t bytes_before = thread_.link().bytes.total;
        queue_.reopen();
        sink_.reopen();
        thread_.resume();
        Status began = begin(source_, sink_, thread_, control_, again, request_);
        if (began.ok()) {
            settle_queue();
            return {};
        }
        wind_up();
        LinkReport link = thread_.link();
        link.bytes.total -= bytes_before;
        began = explain(began.error(), source_, link);
        if (thread_.storage_error()) {
            storage_failed(*thread_.storage_error());
        } else if (link.bytes.total == 0) {
            writer_.drop();
        } else if (Status closed = writer_.close(); !closed.ok()) {
            storage_failed(std::move(closed).error());
        }
        return began;
    }

    bool storage_failed(Error error) {
        outcome_.end = CaptureEnd::storage_failed;
        outcome_.error = std::move(error);
        return false;
    }

    // The pause has used up what was left of the duration.
    bool over(const CaptureProgress& parked) const {
        return request_.duration_s && parked.device_s + parked.parked_s >= *request_.duration_s;
    }

    ByteSource& source_;
    const CaptureRequest& request_;
    const CaptureObserver& observe_;
    SegmentWriter& writer_;
    TransferQueue queue_;
    QueueingSink sink_;
    WriterThread thread_;
    BoardControl control_;
    const Clock::time_point start_ = Clock::now();
    unsigned connections_ = 1;
    double tolerated_stall_s_ = 0.0;
    Silence silence_;
    CaptureOutcome outcome_;
};

}  // namespace

Result<CaptureOutcome> run_capture(ByteSource& source, const CaptureRequest& request,
                                   const CaptureObserver& observe) {
    auto writer =
        SegmentWriter::create({.path = request.path,
                               .overwrite = request.overwrite,
                               .rotate_bytes = request.rotate_bytes,
                               .rotate_s = request.rotate_s,
                               .min_free_bytes = request.min_free_bytes},
                              source.identity(), request.disk != nullptr ? *request.disk : computers_disk());
    if (!writer.ok()) { return storage_error_of(std::move(writer).error()); }
    return Session(source, request, observe, *writer).run();
}

}  // namespace gyrolog
