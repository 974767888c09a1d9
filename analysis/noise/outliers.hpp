// Outliers: single samples far off their neighbours.
#pragma once

#include <cstddef>
#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct OutlierCount {
    std::size_t samples = 0;  // replaced
    double threshold =
        0.0;  // distance from the local median beyond which a sample is one; unit of the column
};

// Hampel's identifier (Hampel 1974; Davies and Gather 1993): a sample more than `sigmas` robust standard
// deviations (1.4826 times the median absolute deviation) from the median of itself and its five neighbours
// on either side is replaced by that median. Windows do not reach over a hole. Gaussian noise has one such
// sample in 500 million at 6 sigmas. Samples whose median absolute deviation is 0 (a converter much coarser
// than the noise) are left alone.
OutlierCount replace_outliers(Column& column, std::span<const Segment> segments, double sigmas = 6.0);

}  // namespace gyrolog
