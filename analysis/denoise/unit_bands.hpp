// What the units of an array have in common, octave by octave, at rest.
//
// The samples are averaged in pairs again and again; at each octave half the mean product of the differences
// of each pair's averages,
//   C_ij(tau) = < (y_i,2k+1 - y_i,2k) (y_j,2k+1 - y_j,2k) > / 2,
// is the Allan covariance of units i and j (its diagonal the Allan variances). The difference passes mostly
// the frequencies from 1 / (4 tau) to 1 / (2 tau). What is common to all units does not average out.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct UnitBand {
    double tau_s = 0.0;
    double from_hz = 0.0;
    double to_hz = 0.0;
    std::size_t differences = 0;     // averaged
    std::vector<double> covariance;  // units x units, the unit of the columns squared
    double mean_correlation = 0.0;   // of the pairs of different units
    double correlation_sd = 0.0;     // of that mean, if the units were independent
    double gain_mean = 0.0;          // mean variance of the units over that of their plain mean
    // The same for the weights of least variance, less what weights gain that were fitted to the very noise:
    // 1' C^-1 1 of so many differences is high by differences / (differences - units + 1). 0 where there are
    // too few differences to tell.
    double gain_best = 0.0;

    double correlation(std::size_t i, std::size_t j, std::size_t units) const;
    // The gain that no number of such units exceeds: 1 / correlation. Infinite unless that is above zero by
    // more than two standard deviations.
    double gain_limit() const;
};

// From two samples' averages on, while there are 8 differences.
std::vector<UnitBand> unit_bands(std::span<const Column* const> units, std::span<const Segment> segments,
                                 double rate_hz);

}  // namespace gyrolog
