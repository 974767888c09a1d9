#include "analysis/numerics/matrix_products.hpp"

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

double dot(std::span<const double> a, std::span<const double> b) { return view_of(a).dot(view_of(b)); }

std::vector<double> product(const Matrix& a, std::span<const double> x) {
    std::vector<double> y(a.rows());
    view_of(std::span<double>(y)).noalias() = view_of(a) * view_of(x);
    return y;
}

std::vector<double> transposed_product(const Matrix& a, std::span<const double> x) {
    std::vector<double> y(a.columns());
    view_of(std::span<double>(y)).noalias() = view_of(a).transpose() * view_of(x);
    return y;
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c(a.rows(), b.columns());
    view_of(c).noalias() = view_of(a) * view_of(b);
    return c;
}

Matrix transposed_product(const Matrix& a, const Matrix& b) {
    Matrix c(a.columns(), b.columns());
    view_of(c).noalias() = view_of(a).transpose() * view_of(b);
    return c;
}

Matrix product_with_transposed(const Matrix& a, const Matrix& b) {
    Matrix c(a.rows(), b.rows());
    view_of(c).noalias() = view_of(a) * view_of(b).transpose();
    return c;
}

double trace_of_product(const Matrix& a, const Matrix& b) {
    double sum = 0.0;
    for (std::size_t j = 0; j < a.columns(); ++j) {
        for (std::size_t i = 0; i < a.rows(); ++i) { sum += a(i, j) * b(j, i); }
    }
    return sum;
}

Matrix transposed(const Matrix& a) {
    Matrix result(a.columns(), a.rows());
    for (std::size_t j = 0; j < a.columns(); ++j) {
        for (std::size_t i = 0; i < a.rows(); ++i) { result(j, i) = a(i, j); }
    }
    return result;
}

void add_square(Matrix& sum, double weight, std::span<const double> x) {
    for (std::size_t j = 0; j < x.size(); ++j) {
        for (std::size_t i = 0; i < x.size(); ++i) { sum(i, j) += x[j] * (weight * x[i]); }
    }
}

Matrix scaled_on_both_sides(Matrix a, std::span<const double> scale) {
    for (std::size_t j = 0; j < a.columns(); ++j) {
        for (std::size_t i = 0; i < a.rows(); ++i) { a(i, j) = scale[i] * a(i, j) * scale[j]; }
    }
    return a;
}

}  // namespace gyrolog
