// Says of every frame and sample whether it arrived, and of those that did not, where they were lost.
//
// What proves a loss:
//   - A frame number left out is a missing frame: the board numbers every frame that it makes.
//   - A sampling index left out is a missing sample: the board numbers every sampling instant since its
//     start.
//   - The indices after a start begin at 0, so a run whose first frames were lost still shows how much is
//     missing.
//   - At the end of a run the STATUS and EVENT frames tell how far the board had counted.
// Across a reset of the board (another boot id, or numbers that begin again) and across a lost connection the
// numbers prove nothing: such a join is told with its two ends, and the clocks say what lies between.
//
// Counters that cannot be true of what came are counted as contradictions, and nothing is concluded from
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "host/decode/contradiction.hpp"
#include "host/decode/frame_decoder.hpp"
#include "host/decode/protocol.hpp"

namespace gyrolog {

enum class DropoutCause : std::uint8_t {
    sensor_fifo_overflow,  // the board says so
    bus_error,             // the board says so
    ring_overflow,         // the board says so: the host did not take frames in time
    data_ready_silent,     // the board says so: the sensor's interrupt stayed away
    device,                // the board counted the loss, but the frame that names the cause was lost too
    link,                  // frames are missing, and the board counted no loss
    silent,                // no sample came, by the board's clock, and the board counted none as lost
    unplugged,             // the connection was lost, and the board has kept its memory
    reset,                 // the board began anew, with or without a lost connection
    stopped,               // by whoever listened, who started the board again later: nothing is missing
};

std::string_view dropout_cause_name(DropoutCause cause);

// Samples first_index ... first_index + samples - 1 of a run.
struct LinkDropout {
    std::uint32_t run = 0;
    std::uint64_t first_index = 0;
    std::uint64_t samples = 0;
    DropoutCause cause = DropoutCause::link;
};

// Where the board came back, or was stopped and started again: nothing was sampled between instant end_index
// of one run, the first one that is not accounted for there, and first_index of the next.
struct LinkJoin {
    std::uint32_t run_before = 0;
    std::uint64_t end_index = 0;
    std::uint32_t run_after = 0;
    std::uint64_t first_index = 0;
    DropoutCause cause = DropoutCause::reset;
};

struct FrameAccounts {
    std::uint64_t good = 0;     // intact, well formed, new
    std::uint64_t missing = 0;  // numbers left out
    std::uint64_t dropped_at_start =
        0;  // numbers left out where the board throws away what was waiting: not missing
    std::uint64_t duplicated = 0;  // intact, but not new: came before, or stale
    std::uint64_t corrupted =
        0;  // refused candidates and malformed messages; a missing number usually goes with one
    std::array<std::uint64_t, glp_status_count> corrupted_by_reason{};
    std::uint64_t lost_on_device = 0;  // of the missing ones, as the board's STATUS counts them
};

struct SampleAccounts {
    std::uint64_t good = 0;
    std::uint64_t missing = 0;
    std::uint64_t lost_on_device = 0;  // as the board counts them: a cross-check on `missing`
};

// The numbers of a report. They cost the same however many dropouts there were.
struct LinkCounts {
    ByteAccounts bytes;
    std::uint64_t bytes_skipped_at_head = 0;
    FrameAccounts frames;
    SampleAccounts samples;
    std::uint64_t dropouts_counted = 0;     // listed or not, joins among them
    std::uint64_t samples_in_joins = 0;     // of the missing ones
    std::uint64_t samples_in_stops = 0;     // neither good nor missing
    std::uint64_t frames_before_start = 0;  // intact, of a stream that ran before this host raised DTR
    // HELLO frames that say other than the one before them within one boot. They are counted as corrupted,
    // and used for nothing.
    std::uint64_t hellos_contradicting = 0;
    std::uint64_t boots = 0;  // of the board, as far as the stream shows
    std::uint64_t runs = 0;
    std::uint64_t samples_frozen = 0;  // of the good ones: one reading again and again
    Contradictions contradictions{};

    // Sampling instants from the first one to the last.
    std::uint64_t instants() const { return samples.good + samples.missing + samples_in_stops; }
};

struct LinkReport : LinkCounts {
    std::vector<LinkDropout> dropouts;  // in order of arrival
    std::uint64_t dropouts_unlisted = 0;
    std::vector<LinkJoin> joins;  // each is a dropout, too, as soon as the clocks say of how many samples
    // Where the board was stopped and started again, over one connection: each is a stop as soon as the
    // clocks say of how many instants.
    std::vector<LinkJoin> restarts;
    std::vector<LinkDropout> stops;
    // Of the missing ones, before the first sample and behind the last: no recording has a place for them.
    std::uint64_t samples_missing_at_start = 0;
    std::uint64_t samples_missing_at_end = 0;

    bool complete() const {
        return frames.missing == 0 && samples.missing == 0 && joins.empty() && samples_frozen == 0 &&
               !any(contradictions);
    }
};

// Where a SAMPLES frame belongs. A run is a stretch with one boot, one start, one configuration and one
// unbroken clock.
struct SamplePlace {
    std::uint32_t boot = 0;
    std::uint32_t run = 0;
};

// Each take_ call is given one frame, in the order of arrival. False or no value means: this frame is a
// duplicate and must be used for nothing. `passed_s`: since the last SAMPLES, where the clocks tell.
class LinkAccounts {
public:
    // What comes next comes over another connection, and a start of the board begins its counters anew.
    void begin_connection() {
        connection_lost_ = numbers_unsure_ = true;
        status_lost_frames_.reset();
    }

    bool take_hello(const glp_frame& frame, const glp_hello& hello);
    bool take_config(const glp_frame& frame, const glp_config& config);
    std::optional<SamplePlace> take_samples(const glp_frame& frame, const glp_samples& samples,
                                            std::optional<double> passed_s = std::nullopt);
    bool take_status(const glp_frame& frame, const glp_device_status& status,
                     std::optional<double> passed_s = std::nullopt);
    bool take_event(const glp_frame& frame, const glp_event& event,
                    std::optional<double> passed_s = std::nullopt);
    bool take_malformed(const glp_frame& frame);
    bool take_other(const glp_frame& frame);  // replies and unknown types
    // So many instants have passed since the last sample by the board's clock (SampleLiveness); 0: none.
    void note_silence(std::uint64_t instants) { silent_instants_ = std::max(silent_instants_, instants); }

    std::uint32_t boot() const { return boot_; }
    // What is known now. Samples that a STATUS or EVENT proves missing at the end are in it.
    LinkReport report(const FrameDecoder& decoder) const;
    LinkCounts counts(const FrameDecoder& decoder) const;
    const std::vector<LinkJoin>& joins() const { return joins_; }
    const std::vector<LinkJoin>& restarts() const { return restarts_; }

private:
    // The end of the run as the board last told it: `next_index` instants have passed, of which up to
    // `pending` may still wait in a frame that is not full.
    struct Tail {
        std::uint64_t next_index = 0;
        std::uint64_t pending = 0;
        std::uint32_t lost_samples = 0;
    };

    bool take_number(const glp_frame& frame, bool new_boot);
    void begin_boot();
    void keep_open(std::uint64_t before_hello);
    std::uint64_t pending_max() const;
    void begin_run(std::uint64_t next_index, std::uint32_t lost_samples);
    bool is_at_start(const glp_frame& frame) const;
    bool is_ahead(const glp_samples& samples, std::uint64_t jump_most) const;
    bool begins_grid(const glp_frame& frame, const glp_samples& samples, std::uint64_t jump_most) const;
    std::optional<Contradiction> misplaced(const glp_frame& frame, const glp_samples& samples,
                                           std::uint64_t jump_most) const;
    void begin_grid(const glp_frame& frame, const glp_samples& samples, bool is_misplaced);
    std::vector<LinkDropout> split(std::uint64_t missing, std::uint64_t lost, std::uint16_t flags) const;
    std::vector<LinkDropout> told_gap() const;
    std::vector<LinkDropout> tail_gap() const;
    void enter(const std::vector<LinkDropout>& gap);
    void join(const LinkJoin& next);
    bool goes_on() const;
    void note(Contradiction kind, std::uint64_t count = 1) {
        contradictions_[static_cast<std::size_t>(kind)] += count;
    }
    void note_lost_samples(std::uint64_t lost, std::uint64_t room);
    void note_lost_frames();
    void take_tail(const Tail& tail, std::optional<double> passed_s);
    static bool is_restart(const glp_frame& frame, const glp_samples& samples, std::uint64_t next_index);

    FrameAccounts frames_;
    std::uint64_t intact_ = 0;
    std::uint64_t malformed_ = 0;  // of the intact ones that were new
    std::optional<std::uint32_t> next_sequence_;
    std::uint64_t frames_before_hello_ = 0;  // left out, and perhaps thrown away by a start
    std::optional<std::uint32_t> boot_id_;
    std::uint32_t boot_ = 0;
    bool booted_since_samples_ = false;
    bool connection_lost_ = false;  // since the last SAMPLES
    bool numbers_unsure_ = false;   // until the first frame of a connection
    bool start_seen_ = false;

    SampleAccounts samples_;
    std::vector<LinkDropout> dropouts_;
    std::uint64_t dropouts_unlisted_ = 0;
    std::vector<LinkJoin> joins_;
    std::vector<LinkJoin> restarts_;
    std::uint32_t run_ = 0;
    bool in_run_ = false;
    std::uint64_t grid_index_ = 0;  // the first of the present grid
    std::uint64_t next_index_ = 0;
    std::uint32_t lost_samples_ = 0;    // the board's counter at the last SAMPLES
    std::uint64_t lost_unplaced_ = 0;   // counted by the board, not yet seen as a jump of the index
    std::uint64_t frames_missing_ = 0;  // since the last SAMPLES
    std::uint16_t told_flags_ = 0;      // causes that EVENT frames named since the last SAMPLES
    std::uint16_t generation_ = 0;
    std::uint8_t layout_ = 0;
    std::uint64_t frame_samples_ = 1;  // of a full frame, as configured or seen
    std::optional<Tail> tail_;
    std::uint64_t silent_instants_ = 0;
    Contradictions contradictions_{};
    bool start_told_ = false;         // since the last SAMPLES
    std::uint64_t grid_lost_ = 0;     // in the present grid, as the board counts them in SAMPLES
    std::uint64_t grid_missing_ = 0;  // in the present grid, by its indices
    std::uint64_t grid_excess_ = 0;   // in the present grid, of the lost ones: what has no room
    std::optional<std::uint32_t> status_lost_frames_;
};

}  // namespace gyrolog
