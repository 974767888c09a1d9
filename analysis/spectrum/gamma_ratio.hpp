// How probable a ratio of two averages of periodogram bins is under noise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/spectrum/averaged_periodogram.hpp"

namespace gyrolog {

// One independent part of a sum: a gamma variable of mean scale * shape.
struct GammaPart {
    double scale = 1.0;
    double shape = 1.0;
};

// The mean of so many neighbouring bins of an averaged periodogram, over its expectation: independent parts
// whose means add up to 1. They are the eigenvalues of the bins' and of the pieces' correlation (a quadratic
// form of Gaussian variables), taken as a product.
std::vector<GammaPart> mean_of_bins(const AveragedPeriodogram& periodogram, std::size_t bins);

// Natural logarithm of the probability that sum(parts) > ratio * R, with R a gamma variable of mean 1 and
// that shape. By saddle point (Lugannani and Rice 1980), some per cent of the probability anywhere in the
// tail; 0 (certain) for ratios up to 1.
double log_tail_of_ratio(std::span<const GammaPart> parts, double reference_shape, double ratio);

}  // namespace gyrolog
