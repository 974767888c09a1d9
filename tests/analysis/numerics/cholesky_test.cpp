#include "analysis/numerics/cholesky.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

TEST(CholeskyFactor, OfTheSecondDifferenceHasItsInverseAndDeterminant) {
    for (const std::size_t size : {1U, 2U, 7U, 60U}) {
        const CholeskyFactor factor(test::second_difference(size));
        ASSERT_TRUE(factor.is_positive_definite());
        EXPECT_NEAR(factor.log_determinant(), std::log(static_cast<double>(size + 1)), 1e-12) << size;
        const Matrix inverse = factor.inverse();
        std::vector<double> right(size, 0.0);
        right.back() = 1.0;
        const std::vector<double> solved = factor.solve(right);
        for (std::size_t i = 0; i < size; ++i) {
            EXPECT_NEAR(solved[i], test::inverse_second_difference(size, i, size - 1), 1e-12) << size;
            for (std::size_t j = 0; j < size; ++j) {
                EXPECT_NEAR(inverse(i, j), test::inverse_second_difference(size, i, j), 1e-12) << size;
            }
        }
    }
}

TEST(CholeskyFactor, ReadsTheLowerHalf) {
    const CholeskyFactor factor(test::matrix_of_rows({{4.0, 99.0}, {2.0, 3.0}}));
    EXPECT_NEAR(factor.log_determinant(), std::log(8.0), 1e-15);
}

TEST(CholeskyFactor, TellsWhatIsNotPositiveDefinite) {
    EXPECT_FALSE(CholeskyFactor(test::matrix_of_rows({{1.0, 2.0}, {2.0, 1.0}})).is_positive_definite());
    EXPECT_FALSE(CholeskyFactor(Matrix(3, 3)).is_positive_definite());
}

TEST(SolveSymmetric, SolvesWhatIsNotDefinite) {
    const std::vector<double> x =
        solve_symmetric(test::matrix_of_rows({{1.0, 2.0}, {2.0, 1.0}}), std::vector{5.0, 4.0});
    EXPECT_NEAR(x[0], 1.0, 1e-14);
    EXPECT_NEAR(x[1], 2.0, 1e-14);
}

TEST(SolveSymmetric, SolvesForEachColumn) {
    const Matrix symmetric = test::matrix_of_rows({{1.0, 2.0}, {2.0, 1.0}});
    const Matrix x = solve_symmetric(symmetric, test::matrix_of_rows({{5.0, 1.0}, {4.0, 2.0}}));
    EXPECT_LT(test::largest_difference(x, test::matrix_of_rows({{1.0, 1.0}, {2.0, 0.0}})), 1e-14);
}

}  // namespace
}  // namespace gyrolog
