#include "analysis/simulate/orientation_rate.hpp"

#include <cmath>
#include <limits>

namespace gyrolog {

namespace {

Quaternion conjugate_times(const Quaternion& a, const Quaternion& b) {
    return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],
            a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
            a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1],
            a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]};
}

// atan(t) for 0 <= t <= 1, in portable arithmetic: halving the angle twice leaves a short series.
double arctangent(double t) {
    const double half = t / (1.0 + std::sqrt(1.0 + t * t));
    const double quarter = half / (1.0 + std::sqrt(1.0 + half * half));
    const double square = quarter * quarter;  // at most 0.04
    double series = 0.0;
    for (int n = 23; n >= 1; n -= 2) { series = 1.0 / n - square * series; }
    return 4.0 * quarter * series;
}

}  // namespace

std::array<double, 3> rotation_vector(const Quaternion& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double cosine = std::fabs(q[0]);
    if (!(norm > 0.0)) {
        const double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, unknown};
    }
    if (sine == 0.0) { return {0.0, 0.0, 0.0}; }
    constexpr double quarter_turn_rad = 1.57079632679489661923;
    const double half_angle_rad =
        sine <= cosine ? arctangent(sine / cosine) : quarter_turn_rad - arctangent(cosine / sine);
    const double scale = std::copysign(2.0 * half_angle_rad / sine, q[0]);
    return {q[1] * scale, q[2] * scale, q[3] * scale};
}

std::vector<std::array<double, 3>> orientation_rate(std::span<const Quaternion> orientation, double rate_hz) {
    std::vector<std::array<double, 3>> rates(orientation.size());
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 3> before = {unknown, unknown, unknown};
    for (std::size_t k = 0; k < orientation.size(); ++k) {
        std::array<double, 3> after = {unknown, unknown, unknown};
        if (k + 1 < orientation.size()) {
            after = rotation_vector(conjugate_times(orientation[k], orientation[k + 1]));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double turn_rad = (before[axis] + after[axis]) / 2.0;
            if (std::isnan(before[axis])) { turn_rad = after[axis]; }
            if (std::isnan(after[axis])) { turn_rad = before[axis]; }
            rates[k][axis] = turn_rad * rate_hz;
        }
        before = after;
    }
    return rates;
}

}  // namespace gyrolog
