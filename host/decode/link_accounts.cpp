#include "host/decode/link_accounts.hpp"

#include <algorithm>
#include <utility>

#include "analysis/recording/recording.hpp"

namespace gyrolog {
namespace {

// A stream that is broken all the time must not fill the memory with its dropouts; the counts stay exact.
constexpr std::size_t dropouts_kept = 100'000;
constexpr std::size_t joins_kept = 10'000;

// No gap of one capture is this long (more than a year at 32 kHz): an index that jumps further is not on the
// grid.
constexpr std::uint64_t implausible_jump = std::uint64_t{1} << 40U;

// Nor are the indices of one start so far apart: their differences fit a signed number.
constexpr std::uint64_t implausible_span = std::uint64_t{1} << 62U;

constexpr std::uint64_t sensor_fifo_bytes = 512;  // of an MPU-9250

// What a sensor makes in so long, if the clocks are no worse than that.
constexpr double fastest_hz = 33'000.0;  // of an MPU-9250, with its clock's error
constexpr double slack_s = 10.0;         // of what had waited on its way

std::uint64_t instants_most(std::optional<double> passed_s) {
    if (!passed_s) { return implausible_jump; }
    const double instants = fastest_hz * (std::max(*passed_s, 0.0) + slack_s);
    return static_cast<std::uint64_t>(std::min(instants, static_cast<double>(implausible_jump)));
}

constexpr std::uint16_t cause_flags =
    glp_flag_sensor_fifo_overflow | glp_flag_bus_error | glp_flag_ring_overflow | glp_flag_data_ready_silent;

DropoutCause cause_of(std::uint16_t flags) {
    if ((flags & glp_flag_sensor_fifo_overflow) != 0) { return DropoutCause::sensor_fifo_overflow; }
    if ((flags & glp_flag_bus_error) != 0) { return DropoutCause::bus_error; }
    if ((flags & glp_flag_ring_overflow) != 0) { return DropoutCause::ring_overflow; }
    if ((flags & glp_flag_data_ready_silent) != 0) { return DropoutCause::data_ready_silent; }
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
        case glp_event_data_ready_silent:
            return glp_flag_data_ready_silent;
        default:
            return 0;
    }
}

// A counter of the board that wraps. One that went down was started again, which counts nothing.
bool went_down(std::uint32_t from, std::uint32_t to) { return to - from >= 0x8000'0000U; }

std::uint32_t counted_up(std::uint32_t from, std::uint32_t to) {
    return went_down(from, to) ? 0U : to - from;
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
        case DropoutCause::data_ready_silent:
            return "data_ready_silent";
        case DropoutCause::device:
            return "device";
        case DropoutCause::link:
            return "link";
        case DropoutCause::silent:
            return "silent";
        case DropoutCause::unplugged:
            return "unplugged";
        case DropoutCause::reset:
            return "reset";
        case DropoutCause::stopped:
            return stopped_cause;
    }
    return "device";
}

// SPEC.md, section 5: a number that is not larger is a duplicate or a stale frame, whatever is in it; only
// HELLO can say that the numbers have begun again.
bool LinkAccounts::take_number(const glp_frame& frame, bool new_boot) {
    ++intact_;
    std::uint32_t jump = next_sequence_ && !new_boot ? frame.sequence - *next_sequence_ : 0U;
    // The first frame of a connection may be a board's that has booted meanwhile: its HELLO comes later.
    if (jump >= 0x8000'0000U && numbers_unsure_) { jump = 0; }
    if (jump >= 0x8000'0000U) {
        ++frames_.duplicated;
        return false;
    }
    numbers_unsure_ = false;
    if (new_boot) { begin_boot(); }
    next_sequence_ = frame.sequence + 1U;
    frames_missing_ += jump;
    frames_.missing += frames_before_hello_;
    frames_before_hello_ = 0;
    if (frame.type == glp_frame_hello) {
        frames_before_hello_ = jump;
        return true;
    }
    frames_.missing += jump;
    return true;
}

void LinkAccounts::begin_boot() {
    ++boot_;
    booted_since_samples_ = true;
    status_lost_frames_.reset();
    told_flags_ = 0;
    frames_missing_ = 0;
}

bool LinkAccounts::take_hello(const glp_frame& frame, const glp_hello& hello) {
    const bool went_back = next_sequence_ && frame.sequence - *next_sequence_ >= 0x8000'0000U;
    const bool new_boot = boot_id_ ? *boot_id_ != hello.boot_id : went_back;
    if (!take_number(frame, new_boot)) { return false; }
    boot_id_ = hello.boot_id;
    return true;
}

bool LinkAccounts::take_config(const glp_frame& frame, const glp_config& config) {
    const std::uint64_t before_hello = frames_before_hello_;
    if (!take_number(frame, false)) { return false; }
    keep_open(before_hello);
    frame_samples_ = std::max<std::uint64_t>(frame_samples_, config.samples_per_frame);
    return true;
}

bool LinkAccounts::take_malformed(const glp_frame& frame) {
    if (!take_number(frame, false)) { return false; }
    ++malformed_;
    return true;
}

bool LinkAccounts::take_other(const glp_frame& frame) { return take_number(frame, false); }

bool LinkAccounts::take_status(const glp_frame& frame, const glp_device_status& status,
                               std::optional<double> passed_s) {
    if (!take_number(frame, false)) { return false; }
    if (status_lost_frames_) {
        frames_.lost_on_device += counted_up(*status_lost_frames_, status.lost_frames);
        note_lost_frames();
    }
    status_lost_frames_ = status.lost_frames;
    if (status.streaming != 0) {
        take_tail({status.next_index, pending_max(), status.lost_samples}, passed_s);
    }
    return true;
}

// Every frame of this start that came before is known, so the counters begin where they ended.
bool LinkAccounts::goes_on() const {
    return in_run_ && frames_missing_ == 0 && !start_told_ && !booted_since_samples_ && !connection_lost_;
}

void LinkAccounts::take_tail(const Tail& tail, std::optional<double> passed_s) {
    if (goes_on()) {
        if (tail.next_index < next_index_ || went_down(lost_samples_, tail.lost_samples)) {
            note(Contradiction::counted_short);
            return;
        }
        note_lost_samples(grid_lost_ + counted_up(lost_samples_, tail.lost_samples),
                          grid_missing_ + (tail.next_index - next_index_));
    }
    if (in_run_ && tail.next_index > next_index_ && tail.next_index - next_index_ > instants_most(passed_s)) {
        note(Contradiction::counted_ahead);
        return;
    }
    tail_ = tail;
}

// In the present grid. A frame that was lost behind the device took samples along that are in no counter, so
// there may be more room than the lost ones need, but never less.
void LinkAccounts::note_lost_samples(std::uint64_t lost, std::uint64_t room) {
    if (lost <= room + grid_excess_) { return; }
    note(Contradiction::lost_samples, lost - room - grid_excess_);
    grid_excess_ = lost - room;
}

void LinkAccounts::note_lost_frames() {
    const std::uint64_t room = frames_.missing + frames_before_hello_ + frames_.dropped_at_start;
    std::uint64_t& noted = contradictions_[static_cast<std::size_t>(Contradiction::lost_frames)];
    if (frames_.lost_on_device > room) { noted = std::max(noted, frames_.lost_on_device - room); }
}

// Of the instants that have passed, those of a frame that is not full and of the sensor's FIFO are not lost
// yet.
std::uint64_t LinkAccounts::pending_max() const {
    const std::size_t sample_bytes = glp_sample_bytes(layout_);
    return frame_samples_ - 1 + (sample_bytes > 0 ? sensor_fifo_bytes / sample_bytes : 0);
}

bool LinkAccounts::take_event(const glp_frame& frame, const glp_event& event,
                              std::optional<double> passed_s) {
    const std::uint64_t before_hello = frames_before_hello_;
    if (!take_number(frame, false)) { return false; }
    told_flags_ = static_cast<std::uint16_t>(told_flags_ | flag_of_event(event.code));
    if (event.code == glp_event_started) {
        keep_open(before_hello);
        frames_.dropped_at_start += std::exchange(frames_before_hello_, 0);
        start_seen_ = start_told_ = true;
        status_lost_frames_ = 0;
    }
    if (event.code == glp_event_stopped) {
        take_tail({event.index, 0, static_cast<std::uint32_t>(event.value)}, passed_s);
    }
    return true;
}

// A start is HELLO, CONFIG, EVENT started (SPEC.md, section 8), before which the board throws away what was
// waiting. Numbers left out before a HELLO are missing only if something else follows.
void LinkAccounts::keep_open(std::uint64_t before_hello) {
    frames_before_hello_ = before_hello;
    frames_.missing -= before_hello;
}

// Nothing came before it that its index could be held against.
bool LinkAccounts::is_at_start(const glp_frame& frame) const {
    return !in_run_ || booted_since_samples_ || (frame.flags & glp_flag_first_after_start) != 0;
}

// Of an index that is not below the next one.
bool LinkAccounts::is_ahead(const glp_samples& samples, std::uint64_t jump_most) const {
    return samples.first_index - next_index_ >= jump_most ||
           samples.first_index - grid_index_ >= implausible_span;
}

bool LinkAccounts::begins_grid(const glp_frame& frame, const glp_samples& samples,
                               std::uint64_t jump_most) const {
    return is_at_start(frame) || samples.first_index < next_index_ || is_ahead(samples, jump_most);
}

// The indices begin again because the board was told to start again, and not because one has gone wrong.
bool LinkAccounts::is_restart(const glp_frame& frame, const glp_samples& samples, std::uint64_t next_index) {
    return (frame.flags & glp_flag_first_after_start) != 0 || samples.first_index < next_index;
}

void LinkAccounts::begin_run(std::uint64_t next_index, std::uint32_t lost_samples) {
    run_ += in_run_ ? 1U : 0U;
    in_run_ = true;
    grid_index_ = next_index;
    next_index_ = next_index;
    lost_samples_ = lost_samples;
    lost_unplaced_ = 0;
    grid_lost_ = grid_missing_ = grid_excess_ = 0;
    tail_.reset();
    silent_instants_ = 0;
}

// An index that cannot be right where it stands: nothing says how many instants lie before it.
std::optional<Contradiction> LinkAccounts::misplaced(const glp_frame& frame, const glp_samples& samples,
                                                     std::uint64_t jump_most) const {
    if (is_at_start(frame)) { return std::nullopt; }
    if (samples.first_index < next_index_) {
        return goes_on() ? std::optional(Contradiction::index_again) : std::nullopt;
    }
    return is_ahead(samples, jump_most) ? std::optional(Contradiction::index_ahead) : std::nullopt;
}

void LinkAccounts::begin_grid(const glp_frame& frame, const glp_samples& samples, bool is_misplaced) {
    const bool start_was_in_stream =
        in_run_ || start_seen_ || (frame.flags & glp_flag_first_after_start) != 0;
    const bool from_zero = start_was_in_stream && samples.first_index < implausible_jump && !is_misplaced;
    const bool came_back = connection_lost_ || booted_since_samples_;
    const bool joins = in_run_ && (came_back || (!is_misplaced && is_restart(frame, samples, next_index_)));
    LinkJoin next{.run_before = run_, .end_index = next_index_};
    // Before the first samples the gap is theirs: their index counts it.
    if (in_run_) {
        for (const LinkDropout& part : tail_gap()) { next.end_index += part.samples; }
        enter(tail_gap());
    }
    begin_run(from_zero ? 0 : samples.first_index, from_zero ? 0 : samples.lost_samples);
    if (!joins) { return; }
    next.run_after = run_;
    next.first_index = next_index_;
    next.cause = booted_since_samples_ ? DropoutCause::reset
                 : connection_lost_    ? DropoutCause::unplugged
                                       : DropoutCause::stopped;
    join(next);
}

std::optional<SamplePlace> LinkAccounts::take_samples(const glp_frame& frame, const glp_samples& samples,
                                                      std::optional<double> passed_s) {
    if (!take_number(frame, false)) { return std::nullopt; }

    const std::uint64_t jump_most = instants_most(passed_s);
    const std::optional<Contradiction> misplacement = misplaced(frame, samples, jump_most);
    if (misplacement) { note(*misplacement); }
    if (begins_grid(frame, samples, jump_most)) {
        begin_grid(frame, samples, misplacement.has_value());
    } else if (samples.config_generation != generation_ || samples.layout != layout_ ||
               (frame.flags & glp_flag_time_discontinuity) != 0) {
        ++run_;
    }
    generation_ = samples.config_generation;
    layout_ = samples.layout;
    frame_samples_ = std::max<std::uint64_t>(frame_samples_, samples.count);

    const std::uint64_t missing = samples.first_index - next_index_;
    const std::uint32_t lost = counted_up(lost_samples_, samples.lost_samples);
    if (went_down(lost_samples_, samples.lost_samples)) { note(Contradiction::counted_short); }
    lost_samples_ = samples.lost_samples;
    samples_.lost_on_device += lost;
    lost_unplaced_ += lost;
    grid_lost_ += lost;
    grid_missing_ += missing;
    note_lost_samples(grid_lost_, grid_missing_);
    if (missing > 0) {
        enter(split(missing, lost_unplaced_, frame.flags));
        lost_unplaced_ -= std::min(missing, lost_unplaced_);
    }
    samples_.good += samples.count;
    next_index_ = samples.first_index + samples.count;
    frames_missing_ = 0;
    told_flags_ = 0;
    booted_since_samples_ = start_told_ = false;
    connection_lost_ = false;
    tail_.reset();
    silent_instants_ = 0;
    return SamplePlace{boot_, run_};
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

// What the board told of the time since the last sample. Before the first one its index counts from a start.
std::vector<LinkDropout> LinkAccounts::told_gap() const {
    if ((!in_run_ && !start_seen_) || !tail_ || tail_->next_index <= next_index_) { return {}; }
    const std::uint64_t passed = tail_->next_index - next_index_;
    if (passed >= implausible_jump) { return {}; }
    const std::uint64_t lost = lost_unplaced_ + counted_up(lost_samples_, tail_->lost_samples);
    const std::uint64_t missing = std::max(passed - std::min(passed, tail_->pending), std::min(passed, lost));
    return missing > 0 ? split(missing, lost, 0) : std::vector<LinkDropout>();
}

std::vector<LinkDropout> LinkAccounts::tail_gap() const {
    std::vector<LinkDropout> gap = told_gap();
    // A board that counts what it loses knows better than its clock.
    if (gap.empty() && silent_instants_ > 0) {
        gap.push_back({run_, next_index_, silent_instants_, DropoutCause::silent});
    }
    return gap;
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

void LinkAccounts::join(const LinkJoin& next) {
    std::vector<LinkJoin>& list = next.cause == DropoutCause::stopped ? restarts_ : joins_;
    if (list.size() < joins_kept) {
        list.push_back(next);
    } else if (next.cause != DropoutCause::stopped) {
        ++dropouts_unlisted_;
    }
}

LinkCounts LinkAccounts::counts(const FrameDecoder& decoder) const {
    LinkCounts counts;
    counts.bytes = decoder.bytes();
    counts.bytes_skipped_at_head = decoder.bytes_skipped_at_head();
    counts.frames = frames_;
    counts.frames.missing += frames_before_hello_;
    for (std::size_t reason = 0; reason < glp_status_count; ++reason) {
        counts.frames.corrupted_by_reason[reason] = decoder.rejected(reason) + decoder.malformed()[reason];
        counts.frames.corrupted += counts.frames.corrupted_by_reason[reason];
    }
    counts.frames.good = intact_ - frames_.duplicated - malformed_;
    counts.samples = samples_;
    counts.contradictions = contradictions_;
    counts.dropouts_counted = dropouts_.size() + joins_.size() + dropouts_unlisted_;
    for (const LinkDropout& part : tail_gap()) {
        counts.samples.missing += part.samples;
        ++counts.dropouts_counted;
    }
    counts.boots = intact_ == 0 ? 0 : boot_ + 1U;
    counts.runs = in_run_ ? run_ + 1U : 0U;
    return counts;
}

LinkReport LinkAccounts::report(const FrameDecoder& decoder) const {
    LinkReport report{counts(decoder), dropouts_, dropouts_unlisted_, joins_, restarts_, {}};
    for (const LinkDropout& part : dropouts_) {
        if (part.run != 0 || part.first_index != report.samples_missing_at_start) { break; }
        report.samples_missing_at_start += part.samples;
    }
    for (const LinkDropout& part : tail_gap()) {
        report.dropouts.push_back(part);
        report.samples_missing_at_end += part.samples;
    }
    return report;
}

}  // namespace gyrolog
