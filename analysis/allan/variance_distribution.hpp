// How an estimate of a deviation's square scatters about its expectation.
//
// The mean of squared terms is a quadratic form in Gaussian variables, sum of lambda_i chi-square_1 with
// lambda the eigenvalues of the terms' covariance. With many terms it is a chi-square with the equivalent
// degrees of freedom; near the end of a record, where few and strongly correlated terms are left, it is not:
// an interval from chi-square at 68.3 % covers 71 to 73 % at a quarter of the record. There the eigenvalues
// are worked out, on a grid of a twelfth of m, and the quantile comes from the saddlepoint of the sum (Kuonen
// 1999, "Saddlepoint approximations for distributions of quadratic forms in normal variables", Biometrika 86,
// in the form of Barndorff-Nielsen), which is right to about 1 % of the tail's probability.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {

class VarianceDistribution {
public:
    // A chi-square with `edf` degrees of freedom, over edf.
    explicit VarianceDistribution(double edf) : edf_(edf) {}

    // sum of lambda_i chi-square_1 + rest, over its mean. lambda > 0.
    VarianceDistribution(std::vector<double> lambda, double rest);

    // Of the mean of squared terms in runs of so many, under a mixture of laws.
    static VarianceDistribution of(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                                   std::span<const std::int64_t> terms_of_runs);

    // Twice the squared mean over the variance.
    double edf() const { return edf_; }

    // What the estimate over its expectation stays below with probability p.
    double quantile(double p) const;

private:
    double edf_ = 0.0;
    std::vector<double> lambda_;  // none: chi-square
    double rest_ = 0.0;
};

}  // namespace gyrolog
