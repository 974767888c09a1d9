#include "analysis/numerics/envelope_cholesky.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/numerics/cholesky.hpp"
#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

std::vector<double> waves(std::size_t size) {
    std::vector<double> values(size);
    for (std::size_t i = 0; i < size; ++i) { values[i] = std::sin(1.0 + static_cast<double>(i)); }
    return values;
}

// Rows of any reach.
TEST(EnvelopeCholesky, SolvesAsTheDenseFactorDoes) {
    const std::size_t size = 40;
    Matrix dense(size, size);
    EnvelopeCholesky factor(0.0);
    for (std::size_t i = 0; i < size; ++i) {
        std::vector<double> row;
        for (std::size_t j = i - std::min<std::size_t>(i, (i * 7) % 5); j < i; ++j) {
            row.push_back(std::cos(static_cast<double>(i + 3 * j)));
            dense(i, j) = dense(j, i) = row.back();
        }
        row.push_back(8.0);
        dense(i, i) = 8.0;
        factor.add_row(row);
    }
    const CholeskyFactor other(dense);
    ASSERT_TRUE(other.is_positive_definite());
    const std::vector<double> solved = factor.solve_transposed(factor.solve_lower(waves(size)));
    const std::vector<double> wanted = other.solve(waves(size));
    const std::vector<double> transposed = factor.solve_transposed(waves(size));
    const std::vector<double> wanted_transposed = other.solve_transposed(waves(size));
    double log_determinant = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        EXPECT_NEAR(solved[i], wanted[i], 1e-14) << i;
        EXPECT_NEAR(transposed[i], wanted_transposed[i], 1e-14) << i;
        log_determinant += 2.0 * std::log(factor.diagonal(i));
    }
    EXPECT_NEAR(log_determinant, other.log_determinant(), 1e-12);
}

// The pivots of a Toeplitz matrix converge, those of the second difference like 1 + 1 / i, of 2.5, -1 like
// 4^-i.
TEST(EnvelopeCholesky, KeepsOneRowForThoseThatNoLongerChange) {
    const std::size_t size = 500;
    EnvelopeCholesky factor(0.0);
    factor.add_row(std::vector{2.5});
    for (std::size_t i = 1; i < size; ++i) { factor.add_row(std::vector{-1.0, 2.5}); }
    double pivot = 2.5;
    for (std::size_t i = 0; i < size; ++i) {
        ASSERT_NEAR(factor.diagonal(i), std::sqrt(pivot), 1e-8) << i;
        pivot = 2.5 - 1.0 / pivot;
    }
    EXPECT_LT(factor.distinct_rows(), 40U);
    EXPECT_EQ(factor.size(), size);
}

TEST(EnvelopeCholesky, HasNoPivotBelowTheLeast) {
    EnvelopeCholesky factor(0.5);
    factor.add_row(std::vector{1.0});
    factor.add_row(std::vector{2.0, 1.0});
    EXPECT_DOUBLE_EQ(factor.diagonal(1), std::sqrt(0.5));
}

}  // namespace
}  // namespace gyrolog
