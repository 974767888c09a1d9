// The longest part of a recording in which nothing turns.
//
// Blocks of a second (at least 16 samples, at most what makes 20 blocks): still where no axis' standard
// deviation within the block exceeds twice that of the quiet blocks (the lower decile), nor does the block's
// mean differ from that of the still block before by more than six standard errors of such a difference and
// half a standard deviation, which is the drift that is allowed. A turn at a constant rate that outlasts all
// rest cannot be told from it.
#pragma once

#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/recording/recording_part.hpp"

namespace gyrolog {

// Of the signals (one value a row, all as long as the recording has rows). Empty (from = to) when there is
// none of at least four blocks.
TimeSpan still_part(const Recording& recording, std::span<const std::vector<double>> signals);

}  // namespace gyrolog
