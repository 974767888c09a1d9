#include "analysis/allan/variance_distribution.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/chi_squared.hpp>

#include "analysis/allan/confidence.hpp"
#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/allan/difference_covariance.hpp"

namespace gyrolog {
namespace {

constexpr std::int64_t cells_a_factor = 12;
constexpr std::int64_t cells_at_most = 144;

// So many cells stand for the terms of a run, each for terms / cells neighbours.
std::int64_t cells_of(std::int64_t terms, const DeviationRule& rule, std::int64_t m) {
    if (!rule.overlapping || m <= cells_a_factor) { return terms; }
    return std::min(terms, std::max(cells_a_factor, (terms * cells_a_factor + m - 1) / m));
}

bool is_angle(std::size_t law) { return law <= index_of(PowerLaw::flicker_angle); }

double sum_of(const VarianceShares& shares) { return std::accumulate(shares.begin(), shares.end(), 0.0); }

// Eigenvalues of one run, which sum to its number of terms times the shares in `shares`.
void append_eigenvalues(const VarianceShares& shares, const DeviationRule& rule, std::int64_t m,
                        std::int64_t terms, std::vector<double>& lambda) {
    const std::int64_t cells = cells_of(terms, rule, m);
    const double step =
        rule.overlapping ? static_cast<double>(terms) / static_cast<double>(cells) : static_cast<double>(m);
    std::vector<double> at_lag(static_cast<std::size_t>(cells));
    for (const PowerLaw law : all_power_laws) {
        if (shares[index_of(law)] <= 0.0) { continue; }
        const DifferenceCovariance covariance(law, rule, m);
        for (std::int64_t j = 0; j < cells; ++j) {
            at_lag[static_cast<std::size_t>(j)] +=
                shares[index_of(law)] * covariance.correlation(static_cast<double>(j) * step);
        }
    }
    Eigen::MatrixXd matrix(cells, cells);
    for (Eigen::Index i = 0; i < cells; ++i) {
        for (Eigen::Index j = 0; j <= i; ++j) { matrix(i, j) = at_lag[static_cast<std::size_t>(i - j)]; }
    }
    matrix *= static_cast<double>(terms) / static_cast<double>(cells);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    const double negligible = 1e-6 * static_cast<double>(terms);
    for (const double value : solver.eigenvalues()) {
        if (value > negligible) { lambda.push_back(value); }
    }
}

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
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        const double t = (1.0 - std::exp(middle)) / (2.0 * largest);
        (normal_at(cumulants(lambda, t), t) > z ? low : high) = middle;
    }
    return cumulants(lambda, (1.0 - std::exp(low)) / (2.0 * largest)).first;
}

}  // namespace

VarianceDistribution::VarianceDistribution(std::vector<double> lambda, double rest)
    : lambda_(std::move(lambda)), rest_(rest) {
    const double mean = std::accumulate(lambda_.begin(), lambda_.end(), rest_);
    for (double& value : lambda_) { value /= mean; }
    rest_ /= mean;
    const double squares = std::inner_product(lambda_.begin(), lambda_.end(), lambda_.begin(), 0.0);
    edf_ = 1.0 / squares;
    // One term alone is a chi-square exactly.
    if (lambda_.size() == 1 && rest_ == 0.0) { lambda_.clear(); }
}

VarianceDistribution VarianceDistribution::of(const VarianceShares& shares, const DeviationRule& rule,
                                              std::int64_t m, std::span<const std::int64_t> terms_of_runs) {
    std::int64_t cells = 0;
    bool every_term = true;
    for (const std::int64_t terms : terms_of_runs) {
        cells += cells_of(terms, rule, m);
        every_term = every_term && cells_of(terms, rule, m) == terms;
    }
    const double total = sum_of(shares);
    const double angle = shares[index_of(PowerLaw::white_angle)] + shares[index_of(PowerLaw::flicker_angle)];
    if (rule.reflected || cells > cells_at_most || (!every_term && angle > 0.5 * total)) {
        std::vector<PowerLaw> laws;
        for (const PowerLaw law : all_power_laws) {
            if (shares[index_of(law)] > 0.0) { laws.push_back(law); }
        }
        return VarianceDistribution(DegreesOfFreedom(laws, rule, m, terms_of_runs).of(shares));
    }
    // Angle noise changes from term to term: within a cell it averages out to its share, which hardly
    // scatters.
    VarianceShares counted = shares;
    if (!every_term) {
        for (std::size_t law = 0; law < power_laws; ++law) {
            if (is_angle(law)) { counted[law] = 0.0; }
        }
    }
    std::vector<double> lambda;
    double rest = 0.0;
    for (const std::int64_t terms : terms_of_runs) {
        append_eigenvalues(counted, rule, m, terms, lambda);
        rest += static_cast<double>(terms) * (total - sum_of(counted));
    }
    return {std::move(lambda), rest};
}

double VarianceDistribution::quantile(double p) const {
    if (lambda_.empty()) { return boost::math::quantile(boost::math::chi_squared(edf_), p) / edf_; }
    return rest_ + saddlepoint_quantile(lambda_, normal_quantile(p));
}

}  // namespace gyrolog
