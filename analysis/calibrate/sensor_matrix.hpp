// A sensor that answers y = M x + b, and the vectors that go in and out of it.
#pragma once

#include <optional>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

double norm(const Vector3& vector);
double dot(const Vector3& a, const Vector3& b);
Vector3 cross(const Vector3& a, const Vector3& b);
Vector3 difference(const Vector3& a, const Vector3& b);
Vector3 sum_of(const Vector3& a, const Vector3& b);
Vector3 scaled(const Vector3& vector, double factor);
// Between two directions, 0 to pi; neither vector is 0.
double angle_rad(const Vector3& a, const Vector3& b);

Vector3 product(const Matrix3& matrix, const Vector3& vector);
Matrix3 product(const Matrix3& a, const Matrix3& b);
Matrix3 transposed(const Matrix3& matrix);
// No value of a singular one.
std::optional<Matrix3> inverse(const Matrix3& matrix);

// Of all corrections s_i (y_i - b_i), axis by axis, the one whose result is nearest to x, over all directions
// of x alike: s_i = M_ii / sum_j M_ij^2. For programs that have no matrix.
Vector3 axis_scales(const Matrix3& M);

}  // namespace gyrolog
