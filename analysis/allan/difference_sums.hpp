// The hot loop: sums of squared second differences of an integrated signal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/prefix_sum.hpp"

namespace gyrolog {

// One unbroken stretch of theta, of which the differences with k >= begin count.
struct Stretch {
    PrefixSum theta;
    std::size_t begin = 0;
};

// For each m: sum over stretches and over k = begin ... points - 2m - 1 of (theta_{k+2m} - 2 theta_{k+m} +
// theta_k)^2.
//
// Sensor counts: the sum is exact, in whole numbers, and rounded once, to the double that is returned. Real
// numbers: partial sums are taken in a fixed order. Either way the result is the same bits for any number of
// threads and on any machine.
std::vector<double> sums_of_squared_differences(std::span<const Stretch> stretches,
                                                std::span<const std::int64_t> m, unsigned threads);

}  // namespace gyrolog
