#include "host/decode/link_accounts.hpp"

#include <algorithm>
#include <cstring>

namespace gyrolog {
namespace {

// A stream that is broken all the time must not fill the memory with its dropouts; the counts stay exact.
constexpr std::size_t dropouts_kept = 100'000;

// No gap of one capture is this long (more than a year at 32 kHz): an index that jumps further is not on the
// grid.
constexpr std::uint64_t implausible_jump = std::uint64_t{1} << 40U;

constexpr std::uint16_t cause_flags =
    glp_flag_sensor_fifo_overflow | glp_flag_bus_error | glp_flag_ring_overflow;

std::uint64_t fingerprint(const glp_frame& frame) {
    // Ticks and indices stand at the front of a payload, so its first bytes tell two frames apart.
    std::array<std::uint64_t, 3> words{};
    std::memcpy(words.data(), frame.payload, std::min(frame.payload_bytes, sizeof(words)));
    std::uint64_t hash = frame.type | (std::uint64_t{frame.flags} << 8U) | (frame.payload_bytes << 24U);
    for (const std::uint64_t word : words) { hash = (hash ^ word) * 0x9E3779B97F4A7C15U; }
    return hash;
}

DropoutCause cause_of(std::uint16_t flags) {
    if ((flags & glp_flag_sensor_fifo_overflow) != 0) { return DropoutCause::sensor_fifo_overflow; }
    if ((flags & glp_flag_bus_error) != 0) { return DropoutCause::bus_error; }
    if ((flags & glp_flag_ring_overflow) != 0) { return DropoutCause::ring_overflow; }
    return DropoutCause::device;
}

std::uint16_t flag_of_event(std::uint16_t code) {
    switch (code) {
        case glp_event_sensor_fifo_overflow:
            return glp_flag_sensor_fifo_overflow;
        case glp_event_bus_error:
            return glp_flag_bus_error;
        case glp_event_ring_overflow:
            return glp_flag_ring_overflow;
        default:
            return 0;
    }
}

// A counter of the board that wraps. One that went down was started again, which counts nothing.
std::uint32_t counted_up(std::uint32_t from, std::uint32_t to) {
    const std::uint32_t step = to - from;
    return step < 0x8000'0000U ? step : 0U;
}

}  // namespace

std::string_view dropout_cause_name(DropoutCause cause) {
    switch (cause) {
        case DropoutCause::sensor_fifo_overflow:
            return "sensor_fifo_overflow";
        case DropoutCause::bus_error:
            return "bus_error";
        case DropoutCause::ring_overflow:
            return "ring_overflow";
        case DropoutCause::device:
            return "device";
        case DropoutCause::link:
            return "link";
    }
    return "device";
}

bool LinkAccounts::take_number(const glp_frame& frame, bool new_boot) {
    ++intact_;
    const Fingerprint mark{fingerprint(frame), frame.sequence, true};
    Fingerprint& slot = recent_[frame.sequence % recent_.size()];
    const bool expected = next_sequence_ && frame.sequence == *next_sequence_;
    if (!expected && slot.used && slot.sequence == mark.sequence && slot.value == mark.value) {
        ++frames_.duplicated;
        return false;
    }
    slot = mark;

    if (next_sequence_ && !expected) {
        const std::uint32_t jump = frame.sequence - *next_sequence_;
        const bool went_back = jump >= 0x8000'0000U;
        if (went_back || new_boot) {
            begin_boot();
        } else {
            frames_.missing += jump;
            frames_missing_ += jump;
        }
    } else if (new_boot) {
        begin_boot();
    }
    next_sequence_ = frame.sequence + 1U;
    return true;
}

void LinkAccounts::begin_boot() {
    ++boot_;
    booted_since_samples_ = true;
    boot_id_.reset();
    status_lost_frames_.reset();
    told_flags_ = 0;
    frames_missing_ = 0;
}

bool LinkAccounts::take_hello(const glp_frame& frame, const glp_hello& hello) {
    if (!take_number(frame, boot_id_ && *boot_id_ != hello.boot_id)) { return false; }
    boot_id_ = hello.boot_id;
    return true;
}

bool LinkAccounts::take_config(const glp_frame& frame, const glp_config& config) {
    if (!take_number(frame, false)) { return false; }
    frame_samples_ = std::max<std::uint64_t>(frame_samples_, config.samples_per_frame);
    return true;
}

bool LinkAccounts::take_malformed(const glp_frame& frame) {
    if (!take_number(frame, false)) { return false; }
    ++malformed_;
    return true;
}

bool LinkAccounts::take_other(const glp_frame& frame) { return take_number(frame, false); }

bool LinkAccounts::take_status(const glp_frame& frame, const glp_device_status& status) {
    if (!take_number(frame, false)) { return false; }
    if (status_lost_frames_) {
        frames_.lost_on_device += counted_up(*status_lost_frames_, status.lost_frames);
    }
    status_lost_frames_ = status.lost_frames;
    if (status.streaming != 0) { tail_ = Tail{status.next_index, frame_samples_ - 1, status.lost_samples}; }
    return true;
}

bool LinkAccounts::take_event(const glp_frame& frame, const glp_event& event) {
    if (!take_number(frame, false)) { return false; }
    told_flags_ = static_cast<std::uint16_t>(told_flags_ | flag_of_event(event.code));
    if (event.code == glp_event_started) { start_seen_ = true; }
    if (event.code == glp_event_stopped) { tail_ = Tail{event.index, 0, lost_samples_}; }
    return true;
}

bool LinkAccounts::begins_grid(const glp_frame& frame, const glp_samples& samples) const {
    return !in_run_ || booted_since_samples_ || (frame.flags & glp_flag_first_after_start) != 0 ||
           samples.first_index < next_index_ || samples.first_index - next_index_ >= implausible_jump;
}

void LinkAccounts::begin_run(std::uint64_t next_index, std::uint32_t lost_samples) {
    run_ += in_run_ ? 1U : 0U;
    in_run_ = true;
    next_index_ = next_index;
    lost_samples_ = lost_samples;
    lost_unplaced_ = 0;
    tail_.reset();
}

std::optional<SamplePlace> LinkAccounts::take_samples(const glp_frame& frame, const glp_samples& samples) {
    if (!take_number(frame, false)) { return std::nullopt; }

    bool continues_grid = in_run_;
    if (begins_grid(frame, samples)) {
        const bool start_was_in_stream =
            in_run_ || start_seen_ || (frame.flags & glp_flag_first_after_start) != 0;
        const bool from_zero = start_was_in_stream && samples.first_index < implausible_jump;
        enter(tail_gap());
        begin_run(from_zero ? 0 : samples.first_index, from_zero ? 0 : samples.lost_samples);
        continues_grid = false;
    } else if (samples.config_generation != generation_ || samples.layout != layout_ ||
               (frame.flags & glp_flag_time_discontinuity) != 0) {
        ++run_;
    }
    generation_ = samples.config_generation;
    layout_ = samples.layout;
    frame_samples_ = std::max<std::uint64_t>(frame_samples_, samples.count);

    const std::uint64_t missing = samples.first_index - next_index_;
    const std::uint32_t lost = counted_up(lost_samples_, samples.lost_samples);
    lost_samples_ = samples.lost_samples;
    samples_.lost_on_device += lost;
    lost_unplaced_ += lost;
    if (missing > 0) {
        enter(split(missing, lost_unplaced_, frame.flags));
        lost_unplaced_ -= std::min(missing, lost_unplaced_);
    }
    samples_.good += samples.count;
    next_index_ = samples.first_index + samples.count;
    frames_missing_ = 0;
    told_flags_ = 0;
    booted_since_samples_ = false;
    tail_.reset();
    return SamplePlace{boot_, run_, continues_grid};
}

// The board's part of a gap comes first: it counted exactly that many. The rest was lost on the way, if
// frames are missing at all.
std::vector<LinkDropout> LinkAccounts::split(std::uint64_t missing, std::uint64_t lost,
                                             std::uint16_t flags) const {
    std::vector<LinkDropout> parts;
    const std::uint64_t by_device = frames_missing_ == 0 ? missing : std::min(missing, lost);
    if (by_device > 0) {
        const bool named = (flags & cause_flags) != 0;
        parts.push_back({run_, next_index_, by_device, cause_of(named ? flags : told_flags_)});
    }
    if (missing > by_device) {
        parts.push_back({run_, next_index_ + by_device, missing - by_device, DropoutCause::link});
    }
    return parts;
}

std::vector<LinkDropout> LinkAccounts::tail_gap() const {
    if (!in_run_ || !tail_ || tail_->next_index <= next_index_ + tail_->pending) { return {}; }
    const std::uint64_t missing = tail_->next_index - next_index_ - tail_->pending;
    if (missing >= implausible_jump) { return {}; }
    return split(missing, lost_unplaced_ + counted_up(lost_samples_, tail_->lost_samples), 0);
}

void LinkAccounts::enter(const std::vector<LinkDropout>& gap) {
    for (const LinkDropout& part : gap) {
        samples_.missing += part.samples;
        if (dropouts_.size() < dropouts_kept) {
            dropouts_.push_back(part);
        } else {
            ++dropouts_unlisted_;
        }
    }
}

LinkReport LinkAccounts::report(const FrameDecoder& decoder) const {
    LinkReport report;
    report.bytes = decoder.bytes();
    report.bytes_skipped_at_head = decoder.bytes_skipped_at_head();
    report.frames = frames_;
    for (std::size_t reason = 0; reason < glp_status_count; ++reason) {
        report.frames.corrupted_by_reason[reason] = decoder.rejected()[reason] + decoder.malformed()[reason];
        report.frames.corrupted += report.frames.corrupted_by_reason[reason];
    }
    report.frames.good = intact_ - frames_.duplicated - malformed_;
    report.samples = samples_;
    report.dropouts = dropouts_;
    report.dropouts_unlisted = dropouts_unlisted_;
    for (const LinkDropout& part : tail_gap()) {
        report.samples.missing += part.samples;
        report.dropouts.push_back(part);
    }
    report.boots = intact_ == 0 ? 0 : boot_ + 1U;
    report.runs = in_run_ ? run_ + 1U : 0U;
    return report;
}

}  // namespace gyrolog
