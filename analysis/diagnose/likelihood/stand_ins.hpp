// Stand-ins are values for samples that are missing, such as the noise of a stationary model would have
// there: drawn from what the model expects of them given the samples beside them (conditional simulation; H.
// Rue, L. Held, Gaussian Markov Random Fields, 2005, 2.3.1). Likelihoods of spectra take them for samples.
// A value that ignores its neighbours is an outlier behind a low-pass filter, and adds noise at frequencies
// that have hardly any.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

// The inverse of a stationary process' covariance has in row i and column j the value at |i - j| of
//   c_k = integral of cos(2 pi f k / rate) / (S rate^2) df over the whole band.
// The function returns c_0 ... c_lags in 1/(rad/s)^2 from the density `S` by bin, two-sided, in (rad/s)^2/Hz,
// of a record of `length` samples.
std::vector<double> inverse_covariance(const SpectralBins& bins, std::span<const double> density,
                                       double rate_hz, std::size_t length, std::size_t lags);

// The function draws new values for all slots that are not present. `weighted`: the product of the inverse
// covariance with all values, by slot, in 1/(rad/s); so what all samples tell of one that is missing is in
// it. `inverse`: c_0 ... c_lags as above, for what missing samples tell of each other; no eigenvalue of the
// inverse covariance is below `least_inverse`, in the same unit. `noise` draws one number for each slot. The
// function returns the logarithm of the density that the values were drawn from, at what was drawn, in nats
// and without the factors 1 / sqrt(2 pi).
double draw_stand_ins(std::span<float> values, const std::vector<bool>& present,
                      std::span<const double> weighted, std::span<const double> inverse, double least_inverse,
                      const RandomStream& noise);

}  // namespace gyrolog
