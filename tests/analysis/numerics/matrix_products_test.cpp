#include "analysis/numerics/matrix_products.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/numerics/small_matrices.hpp"

namespace gyrolog {
namespace {

using test::largest_difference;
using test::matrix_of_rows;

TEST(MatrixProducts, OfSmallOnesAreThoseByHand) {
    const Matrix a = matrix_of_rows({{1, 2, 3}, {4, 5, 6}});
    const Matrix b = matrix_of_rows({{1, 0}, {2, 1}, {0, 3}});
    EXPECT_EQ(largest_difference(product(a, b), matrix_of_rows({{5, 11}, {14, 23}})), 0.0);
    EXPECT_EQ(largest_difference(transposed_product(a, a),
                                 matrix_of_rows({{17, 22, 27}, {22, 29, 36}, {27, 36, 45}})),
              0.0);
    EXPECT_EQ(largest_difference(product_with_transposed(a, a), matrix_of_rows({{14, 32}, {32, 77}})), 0.0);
    EXPECT_EQ(product(a, std::vector{1.0, 0.0, -1.0}), (std::vector{-2.0, -2.0}));
    EXPECT_EQ(transposed_product(a, std::vector{1.0, -1.0}), (std::vector{-3.0, -3.0, -3.0}));
    EXPECT_EQ(dot(std::vector{1.0, 2.0, 3.0}, std::vector{4.0, 5.0, 6.0}), 32.0);
    EXPECT_EQ(trace_of_product(a, b), 28.0);
}

TEST(MatrixProducts, OfLargeOnesAreTheSumsTheyStandFor) {
    // Whole numbers: every order of the sums gives the same.
    Matrix a(37, 53);
    Matrix b(53, 41);
    for (std::size_t i = 0; i < a.values().size(); ++i) { a.values()[i] = static_cast<double>(i % 17) - 8.0; }
    for (std::size_t i = 0; i < b.values().size(); ++i) {
        b.values()[i] = static_cast<double>(i % 23) - 11.0;
    }
    Matrix expected(37, 41);
    Matrix a_transposed(53, 37);
    Matrix b_transposed(41, 53);
    for (std::size_t k = 0; k < 53; ++k) {
        for (std::size_t i = 0; i < 37; ++i) { a_transposed(k, i) = a(i, k); }
        for (std::size_t j = 0; j < 41; ++j) { b_transposed(j, k) = b(k, j); }
        for (std::size_t i = 0; i < 37; ++i) {
            for (std::size_t j = 0; j < 41; ++j) { expected(i, j) += a(i, k) * b(k, j); }
        }
    }
    EXPECT_EQ(largest_difference(product(a, b), expected), 0.0);
    EXPECT_EQ(largest_difference(transposed_product(a_transposed, b), expected), 0.0);
    EXPECT_EQ(largest_difference(product_with_transposed(a, b_transposed), expected), 0.0);
}

TEST(MatrixProducts, AddSquaresAndScaleBothSides) {
    Matrix sum = matrix_of_rows({{1, 0}, {0, 1}});
    add_square(sum, 2.0, std::vector{1.0, 3.0});
    EXPECT_EQ(largest_difference(sum, matrix_of_rows({{3, 6}, {6, 19}})), 0.0);
    EXPECT_EQ(largest_difference(scaled_on_both_sides(sum, std::vector{2.0, 0.5}),
                                 matrix_of_rows({{12, 6}, {6, 4.75}})),
              0.0);
    EXPECT_EQ(largest_difference(sum.part(std::vector<std::size_t>{1}, std::vector<std::size_t>{0, 1}),
                                 matrix_of_rows({{6, 19}})),
              0.0);
}

}  // namespace
}  // namespace gyrolog
