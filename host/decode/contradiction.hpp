// A board's counters, frames with right checksums, that cannot be true of what it sent: a fault of its
// firmware, or a file that somebody made. What is missing is then known less well than the numbers say.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gyrolog {

enum class Contradiction : std::uint8_t {
    lost_samples,   // counted as lost, but no gap of the indices has room for them
    lost_frames,    // counted as dropped, but no gap of the frame numbers has room for them
    index_again,    // an index that was passed comes again, and nothing says that the board began anew
    index_ahead,    // an index that the sensor cannot have reached since the last one
    counted_short,  // STATUS or EVENT counts fewer instants, or fewer lost ones, than the samples before it
    counted_ahead,  // STATUS or EVENT counts more instants than can have passed
};
constexpr std::size_t contradiction_kinds = 6;

// How many samples, frames or times of each kind.
using Contradictions = std::array<std::uint64_t, contradiction_kinds>;

bool any(const Contradictions& contradictions);
// Of each kind that there is: "the board counts 50 samples as lost, and no gap in its indices has room for
// them".
std::vector<std::string> sentences(const Contradictions& contradictions);

}  // namespace gyrolog
