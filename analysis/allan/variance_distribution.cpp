#include "analysis/allan/variance_distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/allan/difference_covariance.hpp"
#include "analysis/allan/total_variance.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {
namespace {

constexpr std::int64_t cells_a_factor = 12;
constexpr std::int64_t cells_at_most = 144;

// So many cells stand for the terms of a run, each for terms / cells neighbours.
std::int64_t cells_of(std::int64_t terms, const DeviationRule& rule, std::int64_t m) {
    if (!rule.overlapping || m <= cells_a_factor) { return terms; }
    return std::min(terms, std::max(cells_a_factor, (terms * cells_a_factor + m - 1) / m));
}

constexpr std::array angle_laws = {PowerLaw::white_angle, PowerLaw::flicker_angle};

double sum_of(const VarianceShares& shares) { return std::accumulate(shares.begin(), shares.end(), 0.0); }

// Expected square over the true one.
double bias_of(PowerLaw law, const DeviationRule& rule, std::int64_t terms, std::int64_t m) {
    return rule.reflected ? total_bias(law, terms, m) : 1.0;
}

// Covariance of the cells of one run, each as wide as `step` terms, relative to the true variance.
class CellCovariance {
public:
    CellCovariance(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                   std::int64_t terms, std::int64_t cells)
        : matrix_(static_cast<std::size_t>(cells), static_cast<std::size_t>(cells)),
          points_(static_cast<double>(terms + 2)),
          step_(rule.overlapping ? static_cast<double>(terms) / static_cast<double>(cells)
                                 : static_cast<double>(m)) {
        for (const PowerLaw law : all_power_laws) {
            const double share = shares[index_of(law)];
            if (share <= 0.0) { continue; }
            const DifferenceCovariance covariance(law, rule, m);
            if (rule.reflected) {
                add_reflected(covariance, share / covariance.at(0.0));
            } else {
                add_stationary(covariance, share);
            }
        }
    }

    // Only the lower half is filled.
    const Matrix& matrix() const { return matrix_; }

private:
    void add_stationary(const DifferenceCovariance& covariance, double share) {
        for (std::size_t lag = 0; lag < matrix_.rows(); ++lag) {
            const double value = share * covariance.correlation(static_cast<double>(lag) * step_);
            for (std::size_t i = lag; i < matrix_.rows(); ++i) { matrix_(i, i - lag) += value; }
        }
    }

    void add_reflected(const DifferenceCovariance& covariance, double factor) {
        const auto place = [&](std::size_t i) { return 0.5 + (static_cast<double>(i) + 0.5) * step_; };
        for (std::size_t i = 0; i < matrix_.rows(); ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                matrix_(i, j) += factor * covariance.reflected(place(i), place(j), points_);
            }
        }
    }

    Matrix matrix_;
    double points_;
    double step_;
};

// The sum's cumulant generating function at t: K(t) = -1/2 sum log(1 - 2 lambda t), and its derivatives.
struct Cumulants {
    double k = 0.0;
    double first = 0.0;
    double second = 0.0;
    double third = 0.0;
};

Cumulants cumulants(const std::vector<double>& lambda, double t) {
    Cumulants sum;
    for (const double value : lambda) {
        const double rest = 1.0 - 2.0 * value * t;
        const double tilted = value / rest;
        sum.k -= 0.5 * std::log(rest);
        sum.first += tilted;
        sum.second += 2.0 * tilted * tilted;
        sum.third += 8.0 * tilted * tilted * tilted;
    }
    return sum;
}

// The standard normal quantile that belongs to the point K'(t).
double normal_at(const Cumulants& at, double t) {
    const double w2 = 2.0 * (t * at.first - at.k);
    // At the mean t, w and v are 0; log(v / w) / w tends to a sixth of the skewness.
    if (w2 < 1e-8) {
        return std::copysign(std::sqrt(std::max(w2, 0.0)), t) + at.third / (6.0 * std::pow(at.second, 1.5));
    }
    const double w = std::copysign(std::sqrt(w2), t);
    const double v = t * std::sqrt(at.second);
    return w + std::log(v / w) / w;
}

// K'(t) at the t whose normal_at() is z, which rises with t; t < 1 / (2 largest).
double saddlepoint_quantile(const std::vector<double>& lambda, double z) {
    const double largest = *std::ranges::max_element(lambda);
    // u = 1 - 2 largest t, between 0 and infinity, on a logarithmic scale.
    double low = std::log(1e-6);
    double high = std::log(1e9);
    constexpr int halvings = 42;  // leaves 1e-11
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        const double t = (1.0 - std::exp(middle)) / (2.0 * largest);
        (normal_at(cumulants(lambda, t), t) > z ? low : high) = middle;
    }
    return cumulants(lambda, (1.0 - std::exp(low)) / (2.0 * largest)).first;
}

}  // namespace

VarianceDistribution::VarianceDistribution(const VarianceShares& shares, const DeviationRule& rule,
                                           std::int64_t m, std::span<const std::int64_t> terms_of_runs) {
    std::int64_t cells = 0;
    bool every_term = true;
    for (const std::int64_t terms : terms_of_runs) {
        cells += cells_of(terms, rule, m);
        every_term = every_term && cells_of(terms, rule, m) == terms;
    }
    double angle = 0.0;
    for (const PowerLaw law : angle_laws) { angle += shares[index_of(law)]; }
    if (cells > cells_at_most || (!every_term && angle > 0.5 * sum_of(shares))) {
        set_chi_square(shares, rule, m, terms_of_runs);
    } else {
        set_eigenvalues(shares, rule, m, terms_of_runs);
    }
}

void VarianceDistribution::set_chi_square(const VarianceShares& shares, const DeviationRule& rule,
                                          std::int64_t m, std::span<const std::int64_t> terms_of_runs) {
    std::vector<PowerLaw> laws;
    double truth = 0.0;
    double expected = 0.0;
    for (const PowerLaw law : all_power_laws) {
        if (shares[index_of(law)] <= 0.0) { continue; }
        laws.push_back(law);
        for (const std::int64_t terms : terms_of_runs) {
            const double part = shares[index_of(law)] * static_cast<double>(terms);
            truth += part;
            expected += part * bias_of(law, rule, terms, m);
        }
    }
    edf_ = DegreesOfFreedom(laws, rule, m, terms_of_runs).of(shares);
    mean_ = expected / truth;
}

void VarianceDistribution::set_eigenvalues(const VarianceShares& shares, const DeviationRule& rule,
                                           std::int64_t m, std::span<const std::int64_t> terms_of_runs) {
    double truth = 0.0;
    for (const std::int64_t terms : terms_of_runs) { truth += static_cast<double>(terms) * sum_of(shares); }
    for (const std::int64_t terms : terms_of_runs) {
        const std::int64_t cells = cells_of(terms, rule, m);
        VarianceShares scattering = shares;
        if (cells != terms) {
            // Angle noise changes from term to term: a cell averages it out to its share, which hardly
            // scatters.
            for (const PowerLaw law : angle_laws) {
                constant_ +=
                    shares[index_of(law)] * static_cast<double>(terms) * bias_of(law, rule, terms, m) / truth;
                scattering[index_of(law)] = 0.0;
            }
        }
        const CellCovariance covariance(scattering, rule, m, terms, cells);
        const double weight = static_cast<double>(terms) / static_cast<double>(cells) / truth;
        Matrix weighted = covariance.matrix();
        for (double& value : weighted.values()) { value *= weight; }
        constexpr double negligible = 1e-6;
        for (const double value : symmetric_eigenvalues(weighted)) {
            if (value > negligible) { lambda_.push_back(value); }
        }
    }
    mean_ = std::accumulate(lambda_.begin(), lambda_.end(), constant_);
    edf_ = mean_ * mean_ / std::inner_product(lambda_.begin(), lambda_.end(), lambda_.begin(), 0.0);
    // One term alone is a chi-square exactly.
    if (lambda_.size() == 1 && constant_ == 0.0) { lambda_.clear(); }
}

double VarianceDistribution::quantile(double p) const {
    if (lambda_.empty()) { return mean_ * chi_squared_quantile(edf_, p) / edf_; }
    return constant_ + saddlepoint_quantile(lambda_, normal_quantile(p));
}

}  // namespace gyrolog
