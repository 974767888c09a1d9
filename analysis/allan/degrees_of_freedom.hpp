// How many independent squares the terms of a deviation are worth.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {

// Equivalent degrees of freedom of the mean of squared differences at averaging factor m, in runs of so many
// neighbouring terms each, one at every `stride` samples:
//
//   edf = (sum of terms)^2 / sum over runs, lags j of (terms - |j|) rho(j stride)^2
//
// rho: correlation of the terms (difference_covariance.hpp). This is Greenhall and Riley 2003 ("Uncertainty
// of stability variances based on finite differences", eqs. 9-13; NIST SP 1065 section 5.4.1), for Allan and
// Hadamard differences, modified or not, overlapping or not, summed over the lags instead of by their tables.
// Lags beyond (order + 2) m are left out: only flicker has any correlation there, below 1e-3. Differences of
// different runs are taken as independent.
//
// Total deviation: total_variance.hpp; runs add up.
class DegreesOfFreedom {
public:
    // For mixtures of these laws only: the sums over lags are taken here, once.
    DegreesOfFreedom(std::span<const PowerLaw> laws, const DeviationRule& rule, std::int64_t m,
                     std::span<const std::int64_t> terms_of_runs);

    // 0 without any difference. Shares must not all be 0.
    double of(const VarianceShares& shares) const;
    double of(PowerLaw law) const;

private:
    std::array<std::array<double, power_laws>, power_laws> products_{};  // sums over lags of rho_a rho_b
    double terms_ = 0.0;
};

}  // namespace gyrolog
