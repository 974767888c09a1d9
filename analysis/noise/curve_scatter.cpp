#include "analysis/noise/curve_scatter.hpp"

#include <cmath>

namespace gyrolog {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

CurveScatter::CurveScatter(std::span<const double> tau_s, double reading_sd_db)
    : reading_variance_(reading_sd_db * reading_sd_db) {
    const auto n = static_cast<Index>(tau_s.size());
    MatrixXd correlation(n, n);
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
            const double octaves =
                std::log2(tau_s[static_cast<std::size_t>(i)] / tau_s[static_cast<std::size_t>(j)]);
            correlation(i, j) = std::exp(-std::abs(octaves));
        }
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(correlation);
    vectors_ = solver.eigenvectors();
    values_ = solver.eigenvalues().cwiseMax(0.0);
}

// A grid: the criterion needs the likelihood's height, and steps of a quarter octave give it to 0.1.
CurveScatter::Fit CurveScatter::fit(const VectorXd& residuals_db) const {
    const VectorXd powers = (vectors_.transpose() * residuals_db).cwiseAbs2();
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

MatrixXd CurveScatter::covariance(double smooth_sd_db) const {
    return vectors_ * variances(smooth_sd_db).asDiagonal() * vectors_.transpose();
}

VectorXd CurveScatter::whitened(const VectorXd& residuals_db, double smooth_sd_db) const {
    return (vectors_.transpose() * residuals_db).cwiseQuotient(variances(smooth_sd_db).cwiseSqrt());
}

VectorXd CurveScatter::variances(double smooth_sd_db) const {
    return (smooth_sd_db * smooth_sd_db * values_).array() + reading_variance_;
}

double CurveScatter::minus_two_log_likelihood(const VectorXd& powers, double smooth_sd_db) const {
    const VectorXd variance = variances(smooth_sd_db);
    return variance.array().log().sum() + powers.cwiseQuotient(variance).sum();
}

}  // namespace gyrolog
