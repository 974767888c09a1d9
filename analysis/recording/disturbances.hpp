// Disturbances are short stretches in which something outside moved the sensor: a bump on the bench, a shock,
// a hand on the cable.
//
// A sensor's own noise is loud on one axis at a time, and about as loud as its other loud stretches are. In
// the place of the samples stand their normal scores about the median of their block, so that a heavy tail
// weighs no more than that of normal noise. The power of a block of the recording is what is left of these
// about two means with one step between them, less its two largest squares, so that neither a step of the
// bias nor single samples that are off count.
// A block is loud on an axis where a power of its own, other than the axis' median around it, gains more in
// likelihood than chance has it. Blocks have two lengths: two half periods of a slow bump are a step in a
// short one.
//
// A block is disturbed that lies beyond the tail of one axis' own blocks, for a bump may move one axis alone,
// unless it is a pulse of the sensor's own rather than a swing that dies out, or in which several axes are as
// loud at once as they are not by chance. So are the blocks that follow or lead to it as long as the axis, or
// the axes together, stay loud, for what was bumped rings out, and one more on either side.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct DisturbanceOptions {
    double block_s = 0.25;  // a bump's length
    // In block_s, the shortest first. A bump that swings slowly has a half period or two in a short block,
    // which are a step; in still longer ones rare pulses of a sensor's own look like a bump.
    std::array<std::size_t, 2> block_lengths = {1, 2};
    std::size_t block_samples_least = 16;  // a power is known to a third
    // One block that is loud is a twentieth of the recording then, which is the longest disturbance.
    std::size_t blocks_least = 20;
    // Of the recordings without disturbances the share in which one is found, and of the blocks that are
    // found to be disturbed the share that is not.
    double false_alarms_most = 0.01;
    // Numbers, spread over the recording, that the scores are ranked among: the largest score is 3.8. Among
    // sixteen times as many, 86 instead of 85 of the test's 100 small bumps are found.
    std::size_t magnitudes_most = 4096;
    // Shares of the recording. What lasts longer is not from outside, or cannot be told from a sensor whose
    // noise changes.
    double longest_share = 0.05;
    double together_share = 0.1;
    // A disturbance may last this long where that is more than longest_share, up to together_share: the
    // slowest plausible bump (decay 2 s) has fallen to a twelfth by then.
    double longest_s = 5.0;
};

struct Disturbance {
    std::size_t first = 0;  // row
    std::size_t rows = 0;
    double from_s = 0.0;  // from the first sampling instant
    double to_s = 0.0;
    std::vector<std::size_t> loud;  // signals
    std::vector<double> gain_nats;  // by signal: of a power of its own over the median's
    double largest = 0.0;           // off the means of its blocks, in the signals' unit
};

// The function looks at signals of one value a row each, all as long as the recording has rows.
std::vector<Disturbance> disturbances(const Recording& recording,
                                      std::span<const std::vector<double>> signals,
                                      const DisturbanceOptions& options = {});

}  // namespace gyrolog
