// How the level of the noise goes, beyond a slow course: bursts, and what repeats itself.
#pragma once

#include <vector>

#include "analysis/diagnose/measures/gap_curves.hpp"

namespace gyrolog {

// Of each axis, and of the squares of all together (bursts that they share), by block length in seconds,
// doubling: cube root of the Allan variance of the squared whitened samples over
// that of independent ones, (variance of the squares) / (block length) (D. W. Allan, Proc. IEEE 54 (1966)
// 221, on squares), less 1. Noise that comes in bursts shows at their length. 0 where too few samples are
// judged. Then, by period in seconds, octaves: what the level repeats on any of the axes (repetition.hpp), as
// the normal deviate that is as rare; not of recordings too short for it.
std::vector<GapCurve> noise_level_curves(const Observation& observation);

}  // namespace gyrolog
