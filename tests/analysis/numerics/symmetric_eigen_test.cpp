#include "analysis/numerics/symmetric_eigen.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "analysis/numerics/matrix_products.hpp"
#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

TEST(SymmetricEigen, OfTheSecondDifferenceIsKnown) {
    constexpr std::size_t size = 20;
    const Matrix matrix = test::second_difference(size);
    const SymmetricEigen eigen = symmetric_eigen(matrix);
    const std::vector<double> alone = symmetric_eigenvalues(matrix);
    ASSERT_EQ(eigen.values.size(), size);
    ASSERT_EQ(alone.size(), size);
    for (std::size_t k = 0; k < size; ++k) {
        const double angle = std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(size + 1);
        EXPECT_NEAR(eigen.values[k], 2.0 - 2.0 * std::cos(angle), 1e-13) << k;
        EXPECT_NEAR(alone[k], 2.0 - 2.0 * std::cos(angle), 1e-13) << k;
        const std::vector<double> image = product(matrix, eigen.vectors.column(k));
        for (std::size_t i = 0; i < size; ++i) {
            EXPECT_NEAR(image[i], eigen.values[k] * eigen.vectors(i, k), 1e-13) << k;
        }
        EXPECT_NEAR(dot(eigen.vectors.column(k), eigen.vectors.column(k)), 1.0, 1e-13) << k;
    }
}

TEST(SymmetricEigen, ReadsTheLowerHalf) {
    const std::vector<double> values = symmetric_eigenvalues(test::matrix_of_rows({{0, 99}, {1, 0}}));
    EXPECT_NEAR(values.front(), -1.0, 1e-15);
    EXPECT_NEAR(values.back(), 1.0, 1e-15);
}

}  // namespace
}  // namespace gyrolog
