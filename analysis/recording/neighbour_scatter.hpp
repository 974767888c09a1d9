// White noise of an instrument that is read beside the gyro.
#pragma once

#include <cstddef>
#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// A motion that fades out is smooth over four samples.
inline constexpr std::size_t order_beside_motion = 3;

// One sigma of white noise: the root of the mean square of the differences of neighbours, of this order k,
// over the sum of their squared coefficients, which is (2k)! / (k!)^2. A polynomial of a lower degree drops
// out of them, and what is slow nearly does. The relative variance of the squared result from n differences
// is 3/n for k = 1 and 4.6/n for k = 3. 0 where no k + 1 neighbours are known. Unit: the column's.
double neighbour_scatter(const Column& column, std::span<const Segment> segments, std::size_t order = 1);

}  // namespace gyrolog
