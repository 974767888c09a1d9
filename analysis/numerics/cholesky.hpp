// Equations with a symmetric matrix, by its triangular factor. Only the lower half is read.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// C = L L'.
class CholeskyFactor {
public:
    explicit CholeskyFactor(const Matrix& symmetric);
    ~CholeskyFactor();
    CholeskyFactor(CholeskyFactor&&) noexcept;
    CholeskyFactor& operator=(CholeskyFactor&&) noexcept;
    CholeskyFactor(const CholeskyFactor&) = delete;
    CholeskyFactor& operator=(const CholeskyFactor&) = delete;

    // Where it is not, there is no factor: nothing below may be asked for.
    bool is_positive_definite() const;
    std::vector<double> solve(std::span<const double> right) const;
    Matrix solve(Matrix right) const;
    // The solution x of L' x = right. Of independent standard normal numbers it has the covariance C^-1.
    std::vector<double> solve_transposed(std::span<const double> right) const;
    Matrix inverse() const;
    double log_determinant() const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

// The solution x of C x = right by C = L D L', with pivots: C may be singular, or not definite.
std::vector<double> solve_symmetric(const Matrix& symmetric, std::span<const double> right);
Matrix solve_symmetric(const Matrix& symmetric, const Matrix& right);

}  // namespace gyrolog
