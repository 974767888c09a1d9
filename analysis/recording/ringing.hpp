// What rings out after a blow: a damped oscillation.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

// The grid, for a whole block of values. Measured on oscillations between its points (ringing_test.cpp): less
// than a tenth of their squares is left.
struct RingingOptions {
    std::size_t values_least = 8;  // six parameters, and two more
    std::size_t onsets = 32;       // in the block
    // Half periods in the block, from the least on: up to eight. A faster swing is no pulse, and is not asked
    // about.
    double half_periods_least = 1.0;
    double half_periods_step = 0.33;
    std::size_t swings = 22;
    std::array<double, 4> decays = {0.1, 0.25, 0.6, 2.0};  // time constants, in the block's length
    std::size_t means_most = 64;  // looked at, of the block: eight a half period at the fastest
};

// What is left of the values about a level m and the damped oscillation that explains most of them,
//   m + exp(-t / tau) (a cos(2 pi f t) + b sin(2 pi f t))   from t = 0 on, m before it,
// by least squares in m, a and b at each point of a grid of onsets, frequencies and decays: with the three of
// the grid six parameters. Fewer values than values_least come back about their mean.
std::vector<double> without_ringing(std::span<const double> values, const RingingOptions& options = {});

}  // namespace gyrolog
