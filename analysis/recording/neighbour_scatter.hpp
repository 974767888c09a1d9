// White noise of an instrument that is read beside the gyro.
#pragma once

#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// One sigma of white noise, the root of half the mean square of the differences of neighbours: what is slow
// drops out of them. 0 where no two neighbours are known. Unit: the column's.
double neighbour_scatter(const Column& column, std::span<const Segment> segments);

}  // namespace gyrolog
