// From time stamps to a uniform grid of sampling instants: what the stamps mean, the rate, and where samples
// are missing.
//
// The rate is the slope of a robust line through the stamps of the whole record, never a difference of
// neighbouring stamps: those carry the jitter of the host, and bursts make even their median wrong by a
// factor.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct Grid {
    double rate_hz = 0.0;
    std::optional<double> rate_sd_hz;      // one sigma, from the scatter of block medians about the line
    std::optional<double> stamp_jitter_s;  // one sigma (from the median absolute deviation), about the line
    StampKind stamps = StampKind::none;
    std::vector<Segment> segments;
    std::vector<Dropout> dropouts;
    std::vector<std::string> warnings;
    std::string failure;  // why the stamps give no grid; empty when they do
};

struct GridOptions {
    // s: a clock that was set back by as much was set; what is less is a stamp that came late.
    double clock_set_back_s = 1.0;
    // Periods: a longer step is a dropout, unless later stamps make up for it: halfway between one and two.
    double dropout_periods = 1.5;
    // s: a burst empties a buffer, and the kernel's 64 kB of a serial port last 5.7 s at 115 200 baud. After
    // a longer stretch of regular steps a long one is a hole, however long.
    double burst_longest_s = 10.0;
};

// Stamps are taken as sampling instants when nine in ten of their steps are near whole periods, and less than
// half of the record is missing: else they may be bursts. Holes after a longer stretch than a burst's do not
// count there. Then a step
// of more than 1.5 periods that later stamps do not make up for is a dropout of round(step / period) - 1
// samples. Otherwise they are arrival times: the mean rate is read from them, dropouts cannot be, and a
// warning says so. A stamp that repeats or steps back by less than a second makes the stamps arrival times
// too (with a warning). Fails when there are fewer than two stamps, or the clock was set back by a second or
// more.
Grid grid_from_stamps(std::span<const double> t_s, const GridOptions& options = {});

// The grid of `rows` samples without stamps, taken at a rate that somebody gave.
Grid grid_from_rate(std::size_t rows, double rate_hz);

// Takes rows out of a grid whose samples turned out to be missing, each at its true place: `present[i]` tells
// whether row i stays. Afterwards the segments count the rows that stay.
void punch_holes(Grid& grid, const std::vector<bool>& present);

}  // namespace gyrolog
