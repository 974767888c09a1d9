// Matrices of which everything is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog::test {

inline Matrix matrix_of_rows(std::initializer_list<std::initializer_list<double>> rows) {
    Matrix matrix(rows.size(), rows.begin()->size());
    std::size_t i = 0;
    for (const auto& row : rows) {
        std::size_t j = 0;
        for (const double value : row) { matrix(i, j++) = value; }
        ++i;
    }
    return matrix;
}

// 2 on the diagonal, -1 beside it. Its determinant is size + 1, its inverse (i, j) = min (size + 1 - max) /
// (size + 1) of indices from 1, its eigenvalues 2 - 2 cos(k pi / (size + 1)).
inline Matrix second_difference(std::size_t size) {
    Matrix matrix(size, size);
    for (std::size_t i = 0; i < size; ++i) {
        matrix(i, i) = 2.0;
        if (i > 0) { matrix(i, i - 1) = matrix(i - 1, i) = -1.0; }
    }
    return matrix;
}

inline double inverse_second_difference(std::size_t size, std::size_t i, std::size_t j) {
    const auto low = static_cast<double>(std::min(i, j) + 1);
    const auto high = static_cast<double>(std::max(i, j) + 1);
    const auto n = static_cast<double>(size + 1);
    return low * (n - high) / n;
}

inline double largest_difference(const Matrix& a, const Matrix& b) {
    double largest = a.rows() == b.rows() && a.columns() == b.columns() ? 0.0 : HUGE_VAL;
    for (std::size_t i = 0; i < std::min(a.values().size(), b.values().size()); ++i) {
        largest = std::max(largest, std::abs(a.values()[i] - b.values()[i]));
    }
    return largest;
}

}  // namespace gyrolog::test
