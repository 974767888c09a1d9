// Means of a column over blocks of equal length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct BlockMean {
    std::int64_t index = 0;   // of the block; the first one begins with the first sampling instant
    std::size_t samples = 0;  // that are known, at least one
    double mean = 0.0;        // of those, in the column's unit
};

// The grid is cut into blocks of `instants` sampling instants, at least one. A block without a known sample
// (NaN is not known) is left out. The last block may be cut short by the end of the record.
std::vector<BlockMean> block_means(const Column& column, std::span<const Segment> segments,
                                   std::int64_t instants);

}  // namespace gyrolog
