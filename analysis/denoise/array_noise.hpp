// The noise of the units of an array, as its Kalman filter takes it: white noise and a random walk of the
// bias, each with its correlation between the units.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

inline constexpr std::size_t units_max = 16;

// Of one unit, per sample, in the unit of its samples.
struct UnitNoise {
    double white_variance = 0.0;
    double walk_variance = 0.0;  // of the step from one sample to the next
};

struct ArrayNoise {
    double rate_hz = 0.0;
    std::vector<UnitNoise> units;
    // Between units, row by row, units x units with ones on the diagonal; empty: none.
    std::vector<double> white_correlation{};
    std::vector<double> walk_correlation{};
};

// Of a fitted noise model:
//   white   N^2 rate + (2 pi Q)^2 rate^3 / 12 + converter, and the mean squares of sinusoids and of
//           Gauss-Markov noise with a correlation time below 1 s: what a sample carries besides drift
//   walk    (K^2 + (B^2 / N)^2 + sum of 2 sigma^2 / T of slower Gauss-Markov noise) / rate
// Flicker noise is no random walk; in its place stands the walk whose density is the white noise's where
// flicker's is, at B^2 / (2 pi N^2): the frequency at which the filter changes from one to the other.
// A walk is at least 1e-14 of the white variance, so that a filter settles (after 10^7 samples at most).
UnitNoise unit_noise(const NoiseModel& model, double rate_hz);

// Equal correlation of all pairs.
std::vector<double> equal_correlation(std::size_t units, double correlation);

// `correlation` made one that can be: moved towards none until its least eigenvalue is 0.001 or more.
std::vector<double> possible_correlation(std::vector<double> correlation, std::size_t units);

// Weights of least variance with sum 1, for a covariance (units x units): C^-1 1 / (1' C^-1 1). Empty for a
// matrix that is no covariance.
std::vector<double> least_variance_weights(std::span<const double> covariance, std::size_t units);

}  // namespace gyrolog
