// Bin sums are products of cosine coefficients, summed over each bin of the spectrum. Where a density is
// constant within a bin they are all that least squares need of the coefficients, whatever the density.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"

namespace gyrolog {

using BinSums = std::vector<double>;  // by bin

// The function returns, by bin, sum a_k b_k. The shorter of the two is followed by zeros.
BinSums bin_sums(const SpectralBins& bins, std::span<const float> a, std::span<const float> b);

// The function returns 1 / (S rate) by bin, the inverse of a coefficient's expected square: `density` S is
// two-sided, in the unit of the coefficients squared per Hz.
BinSums bin_weights(std::span<const double> density, double rate_hz);

// The function returns sum_i sums_i weights_i over the bins. Both are of one size, as are those of
// add_multiple.
double weighted_sum(const BinSums& sums, const BinSums& weights);

// The function adds factor * products to the sums.
void add_multiple(BinSums& sums, double factor, const BinSums& products);

}  // namespace gyrolog
