// Products of cosine coefficients, summed over each bin of the spectrum. Where a density is constant within a
// bin they are all that least squares need of the coefficients, whatever the density.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"

namespace gyrolog {

using BinSums = std::vector<double>;  // by bin

// sum over the bin of a_k b_k; the shorter of the two is followed by zeros.
BinSums bin_sums(const SpectralBins& bins, std::span<const float> a, std::span<const float> b);

// 1 / (S rate) by bin.
BinSums bin_weights(std::span<const double> density, double rate_hz);

// sum over the bins of sums_i weights_i. Both are of one size, as are those of add_multiple.
double weighted_sum(const BinSums& sums, const BinSums& weights);

// sums += factor * products.
void add_multiple(BinSums& sums, double factor, const BinSums& products);

}  // namespace gyrolog
