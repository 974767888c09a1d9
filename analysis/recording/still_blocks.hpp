// Short blocks of a recording, and which of them are still.
//
// A block is still where no signal's standard deviation within it exceeds that of the quiet blocks (the lower
// decile) by more than a factor, and goes on from the still block before where no mean differs by more than
// six standard errors of such a difference and half a standard deviation, which is the drift that is allowed.
// A turn at a constant rate that outlasts all rest cannot be told from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct StillBlock {
    std::size_t first = 0;
    std::size_t count = 0;
    std::int64_t index = 0;    // on the grid, of its first sample
    std::vector<double> mean;  // a signal each
    std::vector<double> sd;
};

// Of `block_s`, at least 16 samples, at most what makes 20 blocks. None reaches over a hole.
std::vector<StillBlock> still_blocks(const Recording& recording, std::span<const std::vector<double>> signals,
                                     double block_s);

// Of each signal; at least one block.
std::vector<double> quiet_sds(const std::vector<StillBlock>& blocks, std::size_t signals);

bool is_quiet(const StillBlock& block, const std::vector<double>& quiet, double factor);
bool goes_on(const StillBlock& before, const StillBlock& block, const std::vector<double>& quiet);

}  // namespace gyrolog
