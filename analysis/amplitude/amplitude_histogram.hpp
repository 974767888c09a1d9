// How the samples of a column are distributed about their mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct AmplitudeHistogram {
    std::size_t samples = 0;
    double mean = 0.0;                // unit of the column
    double standard_deviation = 0.0;  // with samples - 1
    double skewness = 0.0;            // 0 for a symmetric distribution
    double excess_kurtosis = 0.0;     // 0 for a Gaussian, positive for heavier tails
    // Of the converter: distance of neighbouring values. 0: not known, the values are on no grid.
    double step = 0.0;
    double first_edge = 0.0;  // lower edge of the first bin
    double bin_width = 0.0;   // a whole number of steps where there is one
    std::vector<std::uint64_t> counts;

    double edge(std::size_t bin) const { return first_edge + static_cast<double>(bin) * bin_width; }
    // How many samples of a Gaussian of this mean and standard deviation fall into a bin.
    double expected(std::size_t bin) const;
};

// At most `most_bins` bins of equal width. Counts of a converter, and real numbers that are all multiples of
// one step apart, have a whole number of steps in a bin: any other width would put one more value into some
// bins than into others. Empty for an empty column; NaN is left out.
AmplitudeHistogram amplitude_histogram(const Column& column, std::size_t most_bins = 200);

}  // namespace gyrolog
