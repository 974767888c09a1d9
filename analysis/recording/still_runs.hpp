// All parts of a recording in which nothing turns, the short ones too.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct StillRunOptions {
    double block_s = 0.25;  // what moves for a shorter time may pass for still
    // Of a block's standard deviation over the quiet ones'. Of 16 samples it exceeds twice their lower decile
    // in one block of a thousand, on each signal; three times, in none.
    double quiet_factor = 3.0;
    std::size_t blocks_least = 4;  // of a run; fewer are still by chance between two motions
    // Left out at either end of a run: a motion begins and ends in them, softly. Twice as many are fewer than
    // `blocks_least`.
    std::size_t edge_blocks = 1;
};

// Runs of still blocks (still_blocks.hpp), in order, each without a hole. Of the signals: one value a row,
// all finite, as long as the recording has rows.
std::vector<Segment> still_runs(const Recording& recording, std::span<const std::vector<double>> signals,
                                const StillRunOptions& options = {});

}  // namespace gyrolog
