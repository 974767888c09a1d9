// Whittle's likelihood of noise (P. Whittle, Arkiv for Matematik 2 (1953) 423), for binned cosine
// coefficients: they are independent and normal, and their mean square over the rate is a density S.
#pragma once

#include <span>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"

namespace gyrolog {

// The function returns -1/2 sum_bins n (ln S + P / S), in nats and without constants. n is the number of
// coefficients of a bin, P its `power` and S its `density`: by bin, two-sided, in one unit, as (rad/s)^2/Hz.
double whittle_log_likelihood_nats(const SpectralBins& bins, std::span<const double> power,
                                   std::span<const double> density);

}  // namespace gyrolog
