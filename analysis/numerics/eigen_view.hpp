// Eigen's views of the plain types and back, for the sources that work with Eigen.
#pragma once

#include <Eigen/Core>
#include <span>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

inline auto view_of(const Matrix& matrix) {
    return Eigen::Map<const Eigen::MatrixXd>(matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
                                             static_cast<Eigen::Index>(matrix.columns()));
}

inline auto view_of(Matrix& matrix) {
    return Eigen::Map<Eigen::MatrixXd>(matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
                                       static_cast<Eigen::Index>(matrix.columns()));
}

inline auto view_of(std::span<const double> vector) {
    return Eigen::Map<const Eigen::VectorXd>(vector.data(), static_cast<Eigen::Index>(vector.size()));
}

inline auto view_of(std::span<double> vector) {
    return Eigen::Map<Eigen::VectorXd>(vector.data(), static_cast<Eigen::Index>(vector.size()));
}

inline std::span<const double> values_of(const Eigen::VectorXd& vector) {
    return {vector.data(), static_cast<std::size_t>(vector.size())};
}

inline Matrix matrix_of(const Eigen::MatrixXd& values) {
    Matrix matrix(static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols()));
    view_of(matrix) = values;
    return matrix;
}

}  // namespace gyrolog
