#include "analysis/calibrate/sensor_matrix.hpp"

#include <cmath>

namespace gyrolog {

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double norm(const Vector3& vector) { return std::sqrt(dot(vector, vector)); }

Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector3 difference(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector3 sum_of(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Vector3 scaled(const Vector3& vector, double factor) {
    return {vector[0] * factor, vector[1] * factor, vector[2] * factor};
}

// By both, sine and cosine: either alone is blind where the other is steep.
double angle_rad(const Vector3& a, const Vector3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

Vector3 product(const Matrix3& matrix, const Vector3& vector) {
    return {dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)};
}

Matrix3 transposed(const Matrix3& matrix) {
    Matrix3 transposed{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) { transposed[i][j] = matrix[j][i]; }
    }
    return transposed;
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    const Matrix3 columns = transposed(b);
    Matrix3 result{};
    for (std::size_t i = 0; i < 3; ++i) { result[i] = product(columns, a[i]); }
    return result;
}

std::optional<Matrix3> inverse(const Matrix3& matrix) {
    const Matrix3 adjugate =
        transposed({cross(matrix[1], matrix[2]), cross(matrix[2], matrix[0]), cross(matrix[0], matrix[1])});
    const double determinant = dot(matrix[0], cross(matrix[1], matrix[2]));
    if (!std::isnormal(determinant)) { return std::nullopt; }
    Matrix3 inverse{};
    for (std::size_t i = 0; i < 3; ++i) { inverse[i] = scaled(adjugate[i], 1.0 / determinant); }
    return inverse;
}

Vector3 axis_scales(const Matrix3& M) {
    Vector3 scales{};
    for (std::size_t i = 0; i < 3; ++i) { scales[i] = M[i][i] / dot(M[i], M[i]); }
    return scales;
}

}  // namespace gyrolog
