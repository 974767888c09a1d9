// How an estimate of a deviation's square scatters about the true one.
//
// The mean of squared terms is a quadratic form in Gaussian variables, sum of lambda_i chi-square_1 with
// lambda the eigenvalues of the terms' covariance. With many terms it is a chi-square with the equivalent
// degrees of freedom; near the end of a record, where few and strongly correlated terms are left, it is not:
// an interval from chi-square at 68.3 % covers 71 to 75 % at a quarter of the record and above. There the
// eigenvalues are worked out, on a grid of a twelfth of m, and the quantile comes from the saddlepoint of the
// sum (Kuonen 1999, "Saddlepoint approximations for distributions of quadratic forms in normal variables",
// Biometrika 86, in the form of Barndorff-Nielsen), which is right to about 1 % of the tail's probability.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {

class VarianceDistribution {
public:
    // Of the mean of squared terms in runs of so many, under a mixture of laws.
    VarianceDistribution(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                         std::span<const std::int64_t> terms_of_runs);

    // Twice the squared mean over the variance.
    double edf() const { return edf_; }

    // What the estimate over the true variance stays below with probability p. Total deviation is biased: its
    // mean is not 1.
    double quantile(double p) const;

private:
    void set_chi_square(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                        std::span<const std::int64_t> terms_of_runs);
    void set_eigenvalues(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                         std::span<const std::int64_t> terms_of_runs);

    double edf_ = 0.0;
    double mean_ = 1.0;
    std::vector<double> lambda_;  // none: chi-square
    double constant_ = 0.0;       // beside the sum of lambda_i chi-square_1
};

}  // namespace gyrolog
