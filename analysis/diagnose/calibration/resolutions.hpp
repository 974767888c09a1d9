// How many simulations tell how much, and what they may take. More of them change an answer only by the
// chance that they make smaller.
#pragma once

#include <cstddef>

namespace gyrolog::resolution {

// A mean surprisal is known to a sixth of its standard deviation.
inline constexpr std::size_t simulations_for_floor = 40;
// They tell a difference of means, draw by draw.
inline constexpr std::size_t paired_simulations = 6;
// Of the corrected model, to judge what it leaves.
inline constexpr std::size_t simulations_after_most = 50;
// A tail of the first, some five of fifty, is known to half of its length: it is asked of so many times more
// simulations, unless it is as good as impossible. In motion each is measured anew, which takes longer.
inline constexpr std::size_t times_more_at_rest = 4;
inline constexpr std::size_t times_more_in_motion = 2;
inline constexpr double impossible_p = 1e-6;
// What simulations and their observations hold at once.
inline constexpr double simulations_bytes_most = 4e9;

}  // namespace gyrolog::resolution
