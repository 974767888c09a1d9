// Samples of a stream as a Recording: counts in columns, and segments on the grid of sampling instants.
//
// One configuration only, because a column has one scale and a recording one rate: the longest stretch is
// kept, and the rest is named in a warning. Restarts within a stretch become segments at their true distance:
// by the board's ticks, or by the host's clock when the board was reset.
//
// Memory: two bytes a value. A stretch that has become shorter than another is dropped at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"
#include "host/decode/link_accounts.hpp"
#include "host/decode/protocol.hpp"
#include "host/decode/sample_timeline.hpp"

namespace gyrolog {

// The columns of a recording of such samples, without rows; and rows of samples of that layout behind theirs.
std::vector<Column> sample_columns(std::uint8_t layout, const glp_config& config);
void append_samples(std::vector<Column>& columns, const glp_samples& samples);
// Whether samples of both can stand in one column.
bool same_setting(const glp_config& a, const glp_config& b);

class RecordingBuilder {
public:
    // Room is made at once for as many samples as so many bytes can hold: columns that grow are copied again
    // and again. What is not used of it takes address space only.
    //
    // With more than one sample per row a row is their mean, as in means_of(), but counted from the first of
    // each run: after a restart, up to half a row beside its place. A row that lacks a sample is missing.
    // Only rows take memory.
    //
    // Without the accelerometer its columns are left out.
    explicit RecordingBuilder(std::uint64_t stream_bytes = 0, std::size_t samples_per_row = 1,
                              bool with_accelerometer = true)
        : samples_per_row_(samples_per_row),
          with_accelerometer_(with_accelerometer),
          bytes_to_come_(stream_bytes) {}

    // `boot` is LinkAccounts::boot() at this frame.
    void take_config(std::uint32_t boot, const glp_config& config);
    void take_samples(const SamplePlace& place, const glp_samples& samples);

    // Of the longest stretch so far.
    std::size_t samples() const { return std::max(current_.rows, longest_.rows) * samples_per_row_; }

    // Error `malformed` when there are no samples, or none whose configuration was told. Leaves the builder
    // empty.
    Result<Recording> finish(std::string name, const SampleTimeline& timeline, const LinkReport& link);
    // Of sampling instant 0 of the recording that was finished: its device time on the host's clock, in
    // seconds.
    std::optional<double> host_start_s() const { return host_start_s_; }

private:
    static constexpr std::size_t fields_max = 7;

    // Consecutive rows.
    struct Piece {
        std::uint32_t boot = 0;
        std::uint32_t run = 0;
        std::uint64_t first_index = 0;  // of its first sample, in its run
        std::size_t first = 0;          // row
        std::size_t count = 0;
    };
    // A row of means that lacks samples yet.
    struct Unfinished {
        std::uint32_t run = 0;
        std::uint64_t run_begin = 0;  // its first index
        std::uint64_t next_index = 0;
        std::size_t samples = 0;
        std::array<double, fields_max> sums{};
    };
    // The grid index of a run's sample.
    struct RunOrigin {
        std::uint32_t run = 0;
        std::uint64_t first_index = 0;
        std::int64_t grid = 0;

        std::int64_t grid_index(std::uint64_t index) const {
            return grid + static_cast<std::int64_t>(index - first_index);
        }
    };
    struct Stretch {
        std::uint32_t boot = 0;
        std::uint16_t generation = 0;
        std::uint8_t layout = 0;
        std::optional<glp_config> config;
        std::vector<Piece> pieces;
        std::array<std::vector<std::int16_t>, fields_max>
            fields;                                         // in the layout's order; temperature always last
        std::array<std::vector<double>, fields_max> means;  // in their place, of several samples a row
        Unfinished unfinished;
        std::size_t rows = 0;

        bool begun() const { return rows > 0 || unfinished.samples > 0; }
    };

    bool belongs(const SamplePlace& place, const glp_samples& samples) const;
    const glp_config* config_of(const SamplePlace& place, const glp_samples& samples) const;
    void close();
    void append(const SamplePlace& place, const glp_samples& samples);
    void append_means(const SamplePlace& place, const glp_samples& samples);
    void enter_rows(const SamplePlace& place, std::uint64_t first_index, std::size_t rows);
    static void fit_dropouts_to_holes(const LinkReport& link, Recording& recording);
    static void set_rate(const Stretch& stretch, const SampleTimeline& timeline, Recording& recording);
    std::vector<RunOrigin> place_on_grid(const std::vector<Piece>& pieces, const SampleTimeline& timeline,
                                         Recording& recording) const;
    void count_in_rows(Recording& recording) const;
    static std::int64_t begin_behind(const LinkReport& link, const RunOrigin& before, const RunOrigin& after);
    static void enter_dropouts(const LinkReport& link, const std::vector<RunOrigin>& origins,
                               Recording& recording);

    bool keeps(std::uint8_t layout, std::size_t field) const;

    std::size_t samples_per_row_;
    bool with_accelerometer_;
    std::optional<glp_config> config_;  // as last told
    std::uint32_t config_boot_ = 0;
    std::uint64_t bytes_to_come_ = 0;
    Stretch current_;
    Stretch longest_;
    std::uint64_t left_out_ = 0;
    std::uint64_t without_config_ = 0;
    std::optional<double> host_start_s_;
};

}  // namespace gyrolog
