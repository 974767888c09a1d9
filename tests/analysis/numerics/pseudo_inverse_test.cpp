#include "analysis/numerics/pseudo_inverse.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

using test::largest_difference;
using test::matrix_of_rows;

TEST(PseudoInverse, OfAStraightLineIsLeastSquares) {
    const Matrix estimators = pseudo_inverse(matrix_of_rows({{1, -1}, {1, 0}, {1, 1}}));
    EXPECT_LT(largest_difference(estimators, matrix_of_rows({{1.0 / 3, 1.0 / 3, 1.0 / 3}, {-0.5, 0, 0.5}})),
              1e-15);
}

TEST(PseudoInverse, SharesAmongColumnsThatAreTheSame) {
    EXPECT_LT(largest_difference(pseudo_inverse(matrix_of_rows({{1, 1}, {1, 1}})),
                                 matrix_of_rows({{0.25, 0.25}, {0.25, 0.25}})),
              1e-15);
}

TEST(SolveLeastSquares, OfAStraightLineIsTheLine) {
    // y = 1 + 2 x, off by (1, -2, 1), which no line follows.
    const std::vector<double> line =
        solve_least_squares(matrix_of_rows({{1, -1}, {1, 0}, {1, 1}}), std::vector{0.0, -1.0, 4.0});
    ASSERT_EQ(line.size(), 2U);
    EXPECT_NEAR(line[0], 1.0, 1e-15);
    EXPECT_NEAR(line[1], 2.0, 1e-15);
}

}  // namespace
}  // namespace gyrolog
