// What reflection does to the total variance of one unbroken stretch, for m up to half of it.
//
// Noise of the rate: edf = b T / tau - c and bias 1 - a tau / T as NIST SP 1065 has them (edf: table 7, there
// in two decimals). White angle noise, which has no entry there: every term beyond an end holds that end
// twice, so the same number of variance 4 comes m - 1 times at each end. It raises the mean, and those terms
// scatter together. Flicker angle noise is taken as white.
#pragma once

#include <cstdint>

#include "analysis/allan/power_law.hpp"

namespace gyrolog {

// Equivalent degrees of freedom, at least 1; `overlapping_edf` those of as many overlapping differences.
double total_edf(PowerLaw law, std::int64_t terms, std::int64_t m, double overlapping_edf);

// Expected total variance over the Allan variance.
double total_bias(PowerLaw law, std::int64_t terms, std::int64_t m);

}  // namespace gyrolog
