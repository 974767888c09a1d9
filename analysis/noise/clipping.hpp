// Samples that end at a wall: the converter's range, or a filter's limit.
#pragma once

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Whether at least twenty samples have the column's largest or its smallest value, and more than twice as
// many as have the value next to it. Noise thins out towards its ends, clipped noise piles up there.
//
// A column of two values only is taken for noise below the converter's resolution, which looks alike.
bool is_clipped(const Column& column);

}  // namespace gyrolog
