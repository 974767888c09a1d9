// Noise whose law is known exactly, made without the product's own generators.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace gyrolog::test {

// The cosine integral. Power series up to 16, above it the asymptotic one (Abramowitz and
// Stegun 5.2.16, 5.2.34, 5.2.38, 5.2.39); good to 1e-6.
inline double cosine_integral(double x) {
    if (x <= 16.0) {
        long double term = 1.0L;
        long double sum = 0.0L;
        for (int n = 1; n < 60; ++n) {
            term *=
                -static_cast<long double>(x) * static_cast<long double>(x) / ((2.0L * n - 1.0L) * 2.0L * n);
            sum += term / (2.0L * n);
        }
        return std::numbers::egamma + std::log(x) + static_cast<double>(sum);
    }
    const double y = 1.0 / (x * x);
    const double f = (1.0 - y * (2.0 - y * (24.0 - y * (720.0 - y * 40320.0)))) / x;
    const double g = (1.0 - y * (6.0 - y * (120.0 - y * (5040.0 - y * 362880.0)))) * y;
    return f * std::sin(x) - g * std::cos(x);
}

// Autocovariance of samples with the two-sided spectrum 1 / f from `lowest` to 1/2 cycle a sample.
inline std::vector<double> flicker_autocovariance(std::size_t lags, double lowest) {
    std::vector<double> r{2.0 * std::log(0.5 / lowest)};
    for (std::size_t k = 1; k < lags; ++k) {
        const auto lag = static_cast<double>(k);
        r.push_back(2.0 * (cosine_integral(std::numbers::pi * lag) -
                           cosine_integral(2.0 * std::numbers::pi * lowest * lag)));
    }
    return r;
}

// Records of a stationary Gaussian process, one a column, by the Cholesky factor of its covariance: exact for
// any autocovariance, at any lag.
inline Eigen::MatrixXd stationary_records(const std::vector<double>& r, Eigen::Index records,
                                          std::uint64_t seed) {
    const auto n = static_cast<Eigen::Index>(r.size());
    const Eigen::MatrixXd covariance = Eigen::MatrixXd::NullaryExpr(
        n, n, [&](Eigen::Index i, Eigen::Index j) { return r[static_cast<std::size_t>(std::abs(i - j))]; });
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::MatrixXd white =
        Eigen::MatrixXd::NullaryExpr(n, records, [&](Eigen::Index, Eigen::Index) { return normal(random); });
    return covariance.llt().matrixL() * white;
}

}  // namespace gyrolog::test
