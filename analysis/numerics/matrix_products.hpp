// Products of matrices and vectors. Sizes must fit.
#pragma once

#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

double dot(std::span<const double> a, std::span<const double> b);
std::vector<double> product(const Matrix& a, std::span<const double> x);
std::vector<double> transposed_product(const Matrix& a, std::span<const double> x);  // a' x
Matrix product(const Matrix& a, const Matrix& b);
Matrix transposed_product(const Matrix& a, const Matrix& b);       // a' b
Matrix product_with_transposed(const Matrix& a, const Matrix& b);  // a b'
double trace_of_product(const Matrix& a, const Matrix& b);
Matrix transposed(const Matrix& a);

// sum += weight x x'
void add_square(Matrix& sum, double weight, std::span<const double> x);

// diag(scale) a diag(scale)
Matrix scaled_on_both_sides(Matrix a, std::span<const double> scale);

}  // namespace gyrolog
