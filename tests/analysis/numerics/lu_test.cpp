#include "analysis/numerics/lu.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

TEST(LuFactors, SolveWhatNeedsPivots) {
    const LuFactors factors(test::matrix_of_rows({{0.0, 2.0}, {3.0, 1.0}}));
    const Matrix solved = factors.solve(test::matrix_of_rows({{4.0, 2.0}, {5.0, 7.0}}));
    EXPECT_LT(test::largest_difference(solved, test::matrix_of_rows({{1.0, 2.0}, {2.0, 1.0}})), 1e-14);
}

TEST(LuFactors, SolveForManyRightSides) {
    const Matrix inverse = LuFactors(test::second_difference(25)).solve(Matrix::identity(25));
    for (std::size_t i = 0; i < 25; ++i) {
        for (std::size_t j = 0; j < 25; ++j) {
            EXPECT_NEAR(inverse(i, j), test::inverse_second_difference(25, i, j), 1e-12);
        }
    }
}

}  // namespace
}  // namespace gyrolog
