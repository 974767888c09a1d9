// Noise whose law is known exactly, made without the product's own generators.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
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

// Many records of one noise, one a column, with what is to be expected of them.
struct NoiseRecords {
    Eigen::MatrixXd records;
    // Expected square of sum w_i y_i, for weights that sum to 0.
    std::function<double(const Eigen::VectorXd& weights)> expected_square;
};

inline NoiseRecords white_records(Eigen::Index samples, Eigen::Index count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    return {Eigen::MatrixXd::NullaryExpr(samples, count,
                                         [&](Eigen::Index, Eigen::Index) { return normal(random); }),
            [](const Eigen::VectorXd& weights) { return weights.squaredNorm(); }};
}

// Running sums of white noise; a step's weight is the sum of the weights that follow it.
inline NoiseRecords walk_records(Eigen::Index samples, Eigen::Index count, std::uint64_t seed) {
    NoiseRecords walk = white_records(samples, count, seed);
    for (Eigen::Index i = 1; i < samples; ++i) { walk.records.row(i) += walk.records.row(i - 1); }
    walk.expected_square = [](const Eigen::VectorXd& weights) {
        Eigen::VectorXd of_steps = weights;
        for (Eigen::Index i = of_steps.size() - 1; i > 0; --i) { of_steps[i - 1] += of_steps[i]; }
        return of_steps.squaredNorm();
    };
    return walk;
}

// Spectrum 1 / f from a thousandth of a cycle a record up to 1/2 cycle a sample, by the Cholesky factor of
// its covariance: exact at any lag.
inline NoiseRecords flicker_records(Eigen::Index samples, Eigen::Index count, std::uint64_t seed) {
    const std::vector<double> r =
        flicker_autocovariance(static_cast<std::size_t>(samples), 1e-3 / static_cast<double>(samples));
    const auto covariance_of = [r](Eigen::Index n) -> Eigen::MatrixXd {
        return Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
            return r[static_cast<std::size_t>(std::abs(i - j))];
        });
    };
    return {covariance_of(samples).llt().matrixL() * white_records(samples, count, seed).records,
            [covariance_of](const Eigen::VectorXd& weights) {
                return weights.dot(covariance_of(weights.size()) * weights);
            }};
}

inline NoiseRecords sum_of(const std::vector<std::pair<double, NoiseRecords>>& parts) {
    NoiseRecords sum{
        Eigen::MatrixXd::Zero(parts.front().second.records.rows(), parts.front().second.records.cols()), {}};
    std::vector<std::pair<double, std::function<double(const Eigen::VectorXd&)>>> squares;
    for (const auto& [factor, noise] : parts) {
        sum.records += factor * noise.records;
        squares.emplace_back(factor * factor, noise.expected_square);
    }
    sum.expected_square = [squares](const Eigen::VectorXd& weights) {
        double square = 0.0;
        for (const auto& [factor, of] : squares) { square += factor * of(weights); }
        return square;
    };
    return sum;
}

}  // namespace gyrolog::test
