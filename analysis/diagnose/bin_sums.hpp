// Products of cosine coefficients, summed over each bin of the spectrum. Where a density is constant within a
// bin they are all that least squares need of the coefficients, whatever the density.
#pragma once

#include <Eigen/Core>
#include <span>

#include "analysis/diagnose/spectral_bins.hpp"

namespace gyrolog {

using BinSums = Eigen::ArrayXd;  // by bin

// sum over the bin of a_k b_k; the shorter of the two is followed by zeros.
BinSums bin_sums(const SpectralBins& bins, std::span<const float> a, std::span<const float> b);

// 1 / (S rate) by bin.
BinSums bin_weights(std::span<const double> density, double rate_hz);

}  // namespace gyrolog
