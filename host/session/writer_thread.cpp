#include "host/session/writer_thread.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gyrolog {
namespace {

constexpr std::chrono::milliseconds longest_wait(100);
constexpr std::int64_t sync_interval_ns = 1'000'000'000;
constexpr std::uint64_t checkpoint_bytes = std::uint64_t{1} << 20U;
constexpr double fastest_hz = 33'000.0;  // of an MPU-9250, with its clock's error
constexpr double clock_error_max = 0.25;
constexpr double slack_s = 10.0;  // of what had waited on its way

}  // namespace

void WriterThread::resume() {
    decoder_.begin_connection();
    started_ = false;
    hello_came_ = false;
    config_came_ = false;
    next_index_.reset();
    last_frame_ns_.reset();
    awaited_from_ns_.reset();
    publish();
    thread_ = std::thread([this] { run(); });
}

void WriterThread::expect_reply(std::uint32_t sequence, std::uint8_t type) {
    const std::lock_guard lock(mutex_);
    expected_ = {sequence, type, 0};
    state_.reply.reset();
}

WriterThread::State WriterThread::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

CaptureProgress WriterThread::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

void WriterThread::run() {
    if (request_.observer != nullptr) { request_.observer->on_decoder(decoder_); }
    while (!queue_.finished()) {
        const TransferQueue::Batch batch = queue_.pop(std::min(longest_wait, until_flush()));
        const std::int64_t came_until_ns = clock_ns(CLOCK_MONOTONIC);
        batch.for_each([&](const Transfer& transfer) { take(transfer); });
        write_out(came_until_ns, append_marks());
        publish();
    }
    write_last();
    publish();
}

std::chrono::milliseconds WriterThread::until_flush() const {
    const std::int64_t past_ns = clock_ns(CLOCK_MONOTONIC) - last_flush_ns_;
    return std::chrono::ceil<std::chrono::milliseconds>(flush_interval - std::chrono::nanoseconds(past_ns));
}

// Whether there were any.
bool WriterThread::append_marks() {
    if (request_.control == nullptr) { return false; }
    bool any = false;
    for (CaptureMark& mark : request_.control->take_marks()) {
        if (state_.storage_error) { return false; }
        if (Status appended = writer_.mark(std::move(mark)); !appended.ok()) {
            fail(std::move(appended).error());
        } else {
            ++marks_;
            any = true;
        }
    }
    return any;
}

// One write a turn, after all that the turn appends: a second one would hold nothing new, and keep what comes
// meanwhile out of the file.
void WriterThread::write_out(std::int64_t came_until_ns, bool at_once) {
    const bool sync_due = came_until_ns - last_sync_ns_ >= sync_interval_ns;
    const bool flush_due = std::chrono::nanoseconds(came_until_ns - last_flush_ns_) >= flush_interval;
    if (!sync_due && !flush_due && !at_once) { return; }
    last_flush_ns_ = came_until_ns;
    if (sync_due) {
        last_sync_ns_ = came_until_ns;
        append_checkpoint();
    }
    if (state_.storage_error) { return; }
    Status written = sync_due ? writer_.sync_soon() : writer_.flush();
    if (!written.ok()) { fail(std::move(written).error()); }
}

void WriterThread::write_last() {
    static_cast<void>(append_marks());
    append_checkpoint();
    if (state_.storage_error) { return; }
    if (Status written = writer_.sync(); !written.ok()) { fail(std::move(written).error()); }
}

// A live board's last frames tell how its stream ended; a file that is played has all the rest ready. To the
// transfer, so the rate is the one of the last publication, or nominal. Once it is enough it stays so: a rate
// that is known better a moment later would let a piece from farther on through.
bool WriterThread::enough_of_what_waits() {
    if (ended_ || !sink_.source_waits()) { return ended_; }
    std::optional<double> rate_hz = rate_hz_;
    if (!rate_hz && decoder_.config()) { rate_hz = decoder_.config()->rate_mHz * 1e-3; }
    ended_ = enough(instants_ + instants_in_joins_, rate_hz);
    return ended_;
}

void WriterThread::take(const Transfer& transfer) {
    if (enough_of_what_waits()) { return; }
    if (!state_.storage_error) {
        if (Status appended = writer_.append(transfer); !appended.ok()) { fail(std::move(appended).error()); }
    }
    if (transfer.carries_stream()) { bytes_since_checkpoint_ += transfer.data.size(); }
    const std::uint64_t frames_before = decoder_.intact_frames();
    const bool begins_anew = decoder_.take(transfer);
    if (decoder_.intact_frames() != frames_before || begins_anew) {
        last_frame_ns_ = transfer.time.monotonic_ns;
    }
    if (transfer.carries_stream() && !transfer.data.empty()) { last_data_ns_ = transfer.time.monotonic_ns; }
    if (samples_came_ && !state_.storage_error) {
        if (Status placed = writer_.take_place(); !placed.ok()) { fail(std::move(placed).error()); }
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
    if (bytes_since_checkpoint_ >= checkpoint_bytes) { append_checkpoint(); }
}

void WriterThread::append_checkpoint() {
    bytes_since_checkpoint_ = 0;
    if (state_.storage_error) { return; }
    Status appended = writer_.checkpoint(counters());
    if (appended.ok()) { return; }
    // A disk without room to spare still takes what came.
    static_cast<void>(writer_.flush());
    fail(std::move(appended).error());
}

CaptureCounters WriterThread::counters() const {
    const LinkCounts link = decoder_.counts();
    return {.stream_bytes = link.bytes.total,
            .frames = link.frames.good,
            .samples = link.samples.good,
            .frames_missing = link.frames.missing,
            .samples_missing = link.samples.missing,
            .transfers_dropped = sink_.transfers_dropped(),
            .bytes_dropped = sink_.bytes_dropped()};
}

void WriterThread::fail(Error error) {
    const std::lock_guard lock(mutex_);
    state_.storage_error = std::move(error);
}

void WriterThread::publish() {
    const LinkCounts link = decoder_.counts();
    const std::lock_guard lock(mutex_);
    progress_.samples = link.samples.good;
    progress_.samples_missing = link.samples.missing;
    progress_.dropouts = link.dropouts_counted;
    progress_.frames_corrupted = link.frames.corrupted;
    progress_.file_bytes = writer_.bytes_written();
    progress_.path = writer_.paths().back();
    progress_.marks = marks_;
    rate_hz_ = plausible_rate_hz();
    instants_in_joins_ = link.samples_in_joins;
    progress_.rate_hz = rate_hz_;
    progress_.silent_s = silent_s();
    progress_.frozen_s = decoder_.liveness().frozen_now_s();
    progress_.hello = decoder_.hello();
    progress_.config = decoder_.config();
    if (latest_ && progress_.config) {
        progress_.temperature_C = progress_.config->temp_offset_mC * 1e-3 +
                                  latest_->temperature * 1e-9 * progress_.config->temp_nC_per_lsb;
    }
    const std::uint64_t instants = instants_ + instants_in_joins_;
    if (progress_.rate_hz) { progress_.device_s = static_cast<double>(instants) / *progress_.rate_hz; }
    state_.line_was_raised = started_;
    state_.has_hello = hello_came_;
    state_.has_config = config_came_;
    state_.frameless_s = last_frame_ns_ ? static_cast<double>(last_data_ns_ - *last_frame_ns_) * 1e-9 : 0.0;
    state_.enough = ended_ || enough(instants, progress_.rate_hz);
    changed_.notify_all();
}

double WriterThread::silent_s() const {
    return awaited_from_ns_ ? static_cast<double>(last_data_ns_ - *awaited_from_ns_) * 1e-9 : 0.0;
}

// A duration is of sampling instants as long as there are any, and of the clock when they stay away.
bool WriterThread::enough(std::uint64_t instants, const std::optional<double>& rate_hz) const {
    if (request_.samples && instants >= *request_.samples) { return true; }
    if (!request_.duration_s) { return false; }
    if (rate_hz && static_cast<double>(instants) >= *request_.duration_s * *rate_hz) { return true; }
    return first_awaited_ns_ && silent_s() > request_.silence_s &&
           static_cast<double>(last_data_ns_ - *first_awaited_ns_) * 1e-9 >= *request_.duration_s;
}

void WriterThread::await_samples(std::int64_t from_ns) {
    awaited_from_ns_ = from_ns;
    if (!first_awaited_ns_) { first_awaited_ns_ = from_ns; }
}

void WriterThread::on_event(const ReceivedFrame& received, const glp_event& event) {
    if (event.code == glp_event_started) { await_samples(received.arrival.monotonic_ns); }
    if (event.code == glp_event_stopped) { awaited_from_ns_.reset(); }
}

void WriterThread::on_status(const ReceivedFrame& received, const glp_device_status& status) {
    if (status.streaming != 0 && !awaited_from_ns_) { await_samples(received.arrival.monotonic_ns); }
}

std::optional<double> WriterThread::plausible_rate_hz() const {
    const std::optional<double> rate_hz = decoder_.rate_hz();
    if (!rate_hz || !decoder_.config()) { return rate_hz; }
    const double nominal_hz = decoder_.config()->rate_mHz * 1e-3;
    return std::fabs(*rate_hz / nominal_hz - 1.0) <= clock_error_max ? *rate_hz : nominal_hz;
}

void WriterThread::on_samples(const ReceivedFrame& received, const glp_samples& samples) {
    latest_ = samples;
    latest_->samples = nullptr;
    samples_came_ = true;
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
    await_samples(last_samples_ns_);
}

void WriterThread::on_reply(const ReceivedFrame& /*frame*/, const glp_reply& reply) {
    const std::lock_guard lock(mutex_);
    if (reply.command_sequence == expected_.command_sequence &&
        reply.command_type == expected_.command_type) {
        state_.reply = reply;
    }
}

}  // namespace gyrolog
