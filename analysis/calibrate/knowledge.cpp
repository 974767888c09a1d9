#include "analysis/calibrate/knowledge.hpp"

#include <cmath>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {

Matrix information_of(const Matrix& derivatives) {
    Matrix information(derivatives.columns(), derivatives.columns());
    for (std::size_t i = 0; i < derivatives.columns(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = 0.0;
            for (std::size_t row = 0; row < derivatives.rows(); ++row) {
                sum += derivatives(row, i) * derivatives(row, j);
            }
            information(i, j) = information(j, i) = sum;
        }
    }
    return information;
}

Matrix covariance_left(const Matrix& information, std::span<const double> prior_sd) {
    const std::size_t size = prior_sd.size();
    Matrix scaled(size, size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) {
            scaled(i, j) = information(i, j) * prior_sd[i] * prior_sd[j] + (i == j ? 1.0 : 0.0);
        }
    }
    return CholeskyFactor(scaled).inverse();
}

std::vector<std::size_t> undetermined(const Matrix& information, std::span<const double> prior_sd,
                                      double share_most) {
    const Matrix covariance = covariance_left(information, prior_sd);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < prior_sd.size(); ++i) {
        if (covariance(i, i) > share_most * share_most) { open.push_back(i); }
    }
    const SymmetricEigen eigen = symmetric_eigen(covariance);
    if (!open.empty() || eigen.values.back() <= share_most * share_most) { return open; }
    std::size_t most = 0;
    const std::size_t last = prior_sd.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) {
        if (std::abs(eigen.vectors(i, last)) > std::abs(eigen.vectors(most, last))) { most = i; }
    }
    return {most};
}

}  // namespace gyrolog
