// Samples that end at a wall: the converter's range, or a filter's limit.
#pragma once

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Whether at least twenty samples have the column's largest or its smallest value, and more than twice as
// many as have the value next to it. Noise thins out towards its ends, clipped noise piles up there.
//
// `alike`: so many neighbours belong together, because a filter before the samples lets them change no
// faster; that many times as many samples are wanted.
//
// A column of two values only is taken for noise below the converter's resolution, which looks alike.
bool is_clipped(const Column& column, double alike = 1.0);

}  // namespace gyrolog
