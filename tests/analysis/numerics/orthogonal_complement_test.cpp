#include "analysis/numerics/orthogonal_complement.hpp"

#include <gtest/gtest.h>

#include "analysis/numerics/matrix_products.hpp"
#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

TEST(OrthogonalComplement, OfEqualNumbersKeepsWhatIsLeftWithoutTheMean) {
    const OrthogonalComplement complement(std::vector(4, 1.0));
    const std::vector<double> a = complement.of(std::vector{1.0, 2.0, 4.0, 9.0});
    const std::vector<double> b = complement.of(std::vector{101.0, 102.0, 104.0, 109.0});
    ASSERT_EQ(a.size(), 3U);
    for (std::size_t i = 0; i < a.size(); ++i) { EXPECT_NEAR(a[i], b[i], 1e-13); }
    EXPECT_NEAR(dot(a, a), 9.0 + 4.0 + 0.0 + 25.0, 1e-13);  // about the mean of 4
}

TEST(OrthogonalComplement, OfACovarianceIsThatOfTheComplement) {
    const OrthogonalComplement complement(std::vector(5, 1.0));
    // Independent numbers stay so; what all have in common goes.
    Matrix covariance = Matrix::identity(5);
    for (double& value : covariance.values()) { value += 7.0; }
    EXPECT_LT(test::largest_difference(complement.of_covariance(covariance), Matrix::identity(4)), 1e-14);
    // x x' becomes that of the complement of x.
    const std::vector<double> x = {1.0, -2.0, 0.5, 3.0, 0.0};
    Matrix square(5, 5);
    add_square(square, 1.0, x);
    Matrix expected(4, 4);
    add_square(expected, 1.0, complement.of(x));
    EXPECT_LT(test::largest_difference(complement.of_covariance(square), expected), 1e-13);
}

TEST(OrthogonalComplement, HasAnOrthonormalBasisAcrossItsDirection) {
    const std::vector<double> direction = {0.2, -3.0, 0.0, 1.5};
    const OrthogonalComplement complement(direction);
    const Matrix basis = complement.basis();
    EXPECT_LT(test::largest_difference(transposed_product(basis, basis), Matrix::identity(3)), 1e-15);
    for (const double along : transposed_product(basis, direction)) { EXPECT_NEAR(along, 0.0, 1e-15); }
    const std::vector<double> x = {1.0, 2.0, 3.0, 4.0};
    const std::vector<double> by_basis = transposed_product(basis, x);
    const std::vector<double> coordinates = complement.of(x);
    for (std::size_t i = 0; i < 3; ++i) { EXPECT_NEAR(by_basis[i], coordinates[i], 1e-14); }
}

TEST(OrthogonalComplement, OfOneNumberIsEmpty) {
    const OrthogonalComplement complement(std::vector{1.0});
    EXPECT_EQ(complement.basis().rows(), 1U);
    EXPECT_EQ(complement.basis().columns(), 0U);
    EXPECT_TRUE(complement.of(std::vector{3.0}).empty());
}

}  // namespace
}  // namespace gyrolog
