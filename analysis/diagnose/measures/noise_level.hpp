// How the level of the noise goes, beyond a slow course: bursts, and what repeats itself.
//
// Bursts of noise: by block length in s, doubling, the cube root of the Allan variance of the squared
// whitened samples over that of independent ones, (variance of the squares) / (block length), less 1 (D. W.
// Allan, Proc. IEEE 54 (1966) 221, on squares). Noise that comes in bursts shows at their length. The value
// is 0 where too few samples are judged. Each axis has a curve, and the squares of all together one: bursts
// that the axes share.
//
// Rhythm of the noise: by period in s, in octaves, what the level repeats on any of the axes
// (numerics/repetition.hpp), as the normal deviate that chance exceeds as rarely. Short recordings have none.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure memory;
extern const Measure rhythm;
}  // namespace measures

void add_noise_level_curves(const Observation& observation, std::vector<GapCurve>& curves);

}  // namespace gyrolog
