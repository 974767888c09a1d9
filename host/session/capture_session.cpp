#include "host/session/capture_session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "host/capture/segment_writer.hpp"
#include "host/session/board_control.hpp"
#include "host/session/queueing_sink.hpp"
#include "host/session/transfer_queue.hpp"
#include "host/session/writer_thread.hpp"
#include "host/transport/stream_size.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds progress_interval(100);
constexpr std::size_t queue_bytes_of_patient_source = std::size_t{2} << 20U;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

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
             const glp_configure& configure, const CaptureRequest& request,
             const std::function<bool()>& ask_caller) {
    bool wanted = true;
    const std::function<bool()> go_on = [&] {
        wanted = wanted && ask_caller();
        return wanted;
    };
    const auto unless_ended = [&](Status status) {
        return wanted ? std::move(status)
                      : Status(Error{ErrorCode::failed,
                                     source.identity().uri + ": ended before the board had answered"});
    };
    GYROLOG_CHECK(source.start(sink));
    GYROLOG_CHECK(unless_ended(control.quiet(go_on)));
    GYROLOG_CHECK(unless_ended(control.configure(configure, go_on)));
    GYROLOG_CHECK(unless_ended(control.start(go_on)));
    // A HELLO from before the start may be that of a stream which somebody else had started.
    const auto identified = [&](const WriterThread::State& state) {
        return (state.line_was_raised || !control.has_line()) && state.has_hello && state.has_config;
    };
    writer.wait(
        milliseconds(static_cast<std::int64_t>(request.hello_timeout_s * 1e3)), go_on,
        [&](const WriterThread::State& state) { return identified(state) || sink.end().has_value(); });
    // The source may have ended with the frames still in the queue.
    if (sink.end()) { writer.join(); }
    if (identified(writer.state())) { return {}; }
    GYROLOG_CHECK(unless_ended({}));
    if (const auto error = sink.error()) { return *error; }
    return Error{ErrorCode::timeout, no_hello};
}

// What the bytes that did come say about a board that did not identify itself, or left a command unanswered.
Error explain(const Error& error, const ByteSource& source, const LinkReport& link) {
    const bool unknown = error.message == no_hello || link.frames.good == 0;
    if (error.code != ErrorCode::timeout || !unknown) { return error; }
    const std::string& uri = source.identity().uri;
    if (link.bytes.total == 0) {
        return {ErrorCode::timeout, uri +
                                        ": nothing came, no HELLO either: this is no gyrolog board, or it "
                                        "hangs; it is let go"};
    }
    if (link.frames.corrupted_by_reason[glp_status_bad_version] > 0) {
        return {ErrorCode::unsupported,
                fmt::format(
                    "{} speaks another major version of the protocol than {}: update gyrolog or the firmware",
                    uri, GLP_PROTOCOL_MAJOR)};
    }
    return {ErrorCode::malformed,
            fmt::format(
                "{}: {} bytes came, but no HELLO and CONFIG frame: this is no gyrolog board, or not its data "
                "port; it is let go",
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

// Of a board that did not begin. A stranger's bytes are kept, for whoever wants to know what it is; what a
// board says when it refuses a request is in the error.
bool is_worth_nothing(const Error& error, const LinkReport& link) {
    return link.bytes.total == 0 || error.code == ErrorCode::invalid_argument;
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
    // Also when the caller's observer throws: the writer ends only with its queue.
    ~Session() { wind_up(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    Result<CaptureOutcome> run() {
        const Status began = begin(source_, sink_, thread_, control_, request_.configure, request_,
                                   [this] { return observe_(progress()); });
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
        source_.let_go();
        const std::optional<Error> refused = thread_.state().storage_error;
        Status closed = refused ? Status(*refused) : Status();
        outcome_.link = thread_.link();
        if (!began.ok() && is_worth_nothing(began.error(), outcome_.link)) { writer_.drop(); }
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
        outcome_.kept_old = writer_.keeps_old();
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
        // A link on which nothing comes at all has no times of arrival.
        progress.silent_s = progress.streaming ? std::max(progress.silent_s, silent_s_) : 0.0;
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
            thread_.wait(progress_interval, [&](const WriterThread::State& state) {
                enough = state.enough;
                refused = state.storage_error.has_value();
                // An old capture may hold any amount of noise; a device that is there may not.
                frameless = !source_.can_wait() && state.frameless_s > request_.idle_timeout_s;
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
            silent_s_ = source_.can_wait() ? 0.0 : silence_.seconds(sink_.data_transfers());
            // The writer goes by what comes. A link on which nothing comes has the clock alone, unless the
            // board is waited for: the silence of a lost board opens it again first.
            const bool is_time_over = request_.on_unplug != OnUnplug::wait && request_.duration_s &&
                                      silent_s_ > request_.silence_s &&
                                      seconds_since(start_) >= *request_.duration_s;
            if (is_time_over || silent_s_ > request_.idle_timeout_s) {
                outcome_.error = Error{
                    ErrorCode::device_lost,
                    fmt::format("{}: silent for {:g} s", source_.identity().uri,
                                std::min(std::floor(10.0 * silent_s_) / 10.0, request_.idle_timeout_s))};
                return end(CaptureEnd::device_lost);
            }
        }
    }
    void end(CaptureEnd how) { outcome_.end = how; }

    Status obey() {
        if (request_.control == nullptr) { return {}; }
        GYROLOG_CHECK(control_.set_streaming(request_.control->streaming_wanted(),
                                             [this] { return observe_(progress()); }));
        if (!control_.streaming()) { silence_.begin(); }
        return {};
    }

    // True when the board streams again. Otherwise the outcome stays that of a lost device, or is a disk that
    // refused the next file.
    bool park() {
        wind_up();
        if (thread_.state().storage_error) { return false; }
        if (Status closed = writer_.close(); !closed.ok()) {
            return storage_failed(std::move(closed).error());
        }
        const auto lost_at = Clock::now();
        std::string why = outcome_.error ? outcome_.error->message : source_.identity().uri + ": lost";
        auto next_try = lost_at;
        const auto go_on = [&] {
            CaptureProgress parked = progress();
            parked.parked = true;
            parked.parked_s = seconds_since(lost_at);
            parked.parked_why = why;
            return observe_(parked) && !over(parked);
        };
        while (true) {
            if (!go_on()) { return false; }
            if (Clock::now() < next_try) {
                std::this_thread::sleep_for(
                    std::min<Clock::duration>(progress_interval, next_try - Clock::now()));
                continue;
            }
            Status back = source_.reconnect();
            if (back.ok()) { back = resume(go_on); }
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
    Status resume(const std::function<bool()>& go_on) {
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
        Status began = begin(source_, sink_, thread_, control_, again, request_, go_on);
        if (began.ok()) {
            settle_queue();
            return {};
        }
        wind_up();
        source_.let_go();
        LinkReport link = thread_.link();
        link.bytes.total -= bytes_before;
        began = explain(began.error(), source_, link);
        if (const std::optional<Error> refused = thread_.state().storage_error) {
            storage_failed(*refused);
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
    double silent_s_ = 0.0;
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
