// Stamp scatter is how far single time stamps are off, whatever the clock does slowly.
#pragma once

#include <optional>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct StampScatter {
    // One sigma of one stamp, from the mean size of the second differences d of stamps that follow each other
    // without a hole: sqrt(pi / 2) mean |d| / sqrt(6), for independent Gaussian errors. A late stamp among
    // thousands counts for little.
    double sd_s = 0.0;
    // The number of independent errors that would tell their sigma as well.
    double independent = 0.0;
    // The stamps are whole multiples of it; 0: of nothing coarser than a nanosecond.
    double resolution_s = 0.0;
    // The correlation of an error with the next about the straight line: near 0 for errors that are
    // independent, near 1 for the bursts of a host.
    double neighbour_correlation = 0.0;
};

// The function returns no value without stamps a row, or with fewer than 16.
std::optional<StampScatter> stamp_scatter(const Recording& recording);

}  // namespace gyrolog
