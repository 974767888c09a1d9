#include "analysis/noise/curve_scatter.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/numerics/eigen_view.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {

CurveScatter::CurveScatter(std::span<const double> tau_s, double reading_sd_db)
    : reading_variance_(reading_sd_db * reading_sd_db) {
    Matrix correlation(tau_s.size(), tau_s.size());
    for (std::size_t i = 0; i < tau_s.size(); ++i) {
        for (std::size_t j = 0; j < tau_s.size(); ++j) {
            const double octaves = std::log2(tau_s[i] / tau_s[j]);
            correlation(i, j) = std::exp(-std::abs(octaves));
        }
    }
    SymmetricEigen axes = symmetric_eigen(correlation);
    vectors_ = std::move(axes.vectors);
    for (const double value : axes.values) { values_.push_back(std::max(value, 0.0)); }
}

// A grid: the criterion needs the likelihood's height, and steps of a quarter octave give it to 0.1.
CurveScatter::Fit CurveScatter::fit(std::span<const double> residuals_db) const {
    std::vector<double> powers = transposed_product(vectors_, residuals_db);
    for (double& power : powers) { power *= power; }
    constexpr int steps = 40;
    constexpr double smallest_db = 0.01;
    constexpr double octaves_per_step = 0.25;  // up to 10 dB
    Fit best{minus_two_log_likelihood(powers, 0.0), 0.0};
    for (int i = 0; i <= steps; ++i) {
        const double sd_db = smallest_db * std::exp2(octaves_per_step * i);
        const double value = minus_two_log_likelihood(powers, sd_db);
        if (value < best.minus_two_log_likelihood) { best = {value, sd_db}; }
    }
    return best;
}

Matrix CurveScatter::covariance(double smooth_sd_db) const {
    const std::vector<double> variance = variances(smooth_sd_db);
    Matrix scaled = vectors_;
    for (std::size_t j = 0; j < scaled.columns(); ++j) {
        for (double& value : scaled.column(j)) { value *= variance[j]; }
    }
    return product_with_transposed(scaled, vectors_);
}

std::vector<double> CurveScatter::whitened(std::span<const double> residuals_db, double smooth_sd_db) const {
    const std::vector<double> variance = variances(smooth_sd_db);
    std::vector<double> white = transposed_product(vectors_, residuals_db);
    for (std::size_t i = 0; i < white.size(); ++i) { white[i] /= std::sqrt(variance[i]); }
    return white;
}

std::vector<double> CurveScatter::variances(double smooth_sd_db) const {
    std::vector<double> variances;
    variances.reserve(values_.size());
    for (const double value : values_) {
        variances.push_back(smooth_sd_db * smooth_sd_db * value + reading_variance_);
    }
    return variances;
}

double CurveScatter::minus_two_log_likelihood(std::span<const double> powers, double smooth_sd_db) const {
    const std::vector<double> variances_db2 = variances(smooth_sd_db);
    const auto variance = view_of(std::span<const double>(variances_db2));
    return variance.array().log().sum() + view_of(powers).cwiseQuotient(variance).sum();
}

}  // namespace gyrolog
