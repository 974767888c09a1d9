#include "analysis/numerics/peak_curvature.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using Point = std::vector<double>;

double quadratic(const Point& at) {
    const double a = at[0] - 1.0;
    const double b = at[1] + 2.0;
    return 7.0 - 0.5 * (400.0 * a * a + 2.0 * 90.0 * a * b + 25.0 * b * b);
}

TEST(PeakCurvature, OfAQuadraticIsItsMatrixAndSdsLeaveTheOthersFree) {
    const PeakCurvature curvature = peak_curvature(quadratic, {1.0, -2.0}, 7.0, 0.002, 3.0);
    EXPECT_NEAR(curvature.information(0, 0), 400.0, 1e-6);
    EXPECT_NEAR(curvature.information(0, 1), 90.0, 1e-6);
    EXPECT_NEAR(curvature.information(1, 0), 90.0, 1e-6);
    EXPECT_NEAR(curvature.information(1, 1), 25.0, 1e-6);
    const double determinant = 400.0 * 25.0 - 90.0 * 90.0;
    EXPECT_NEAR(curvature.sd[0], std::sqrt(25.0 / determinant), 1e-9);
    EXPECT_NEAR(curvature.sd[1], std::sqrt(400.0 / determinant), 1e-9);
}

TEST(PeakCurvature, OfARidgeIsKnownAsWellAsMayBe) {
    const auto ridge = [](const Point& at) { return -0.5 * 100.0 * (at[0] + at[1]) * (at[0] + at[1]); };
    const PeakCurvature curvature = peak_curvature(ridge, {0.0, 0.0}, 0.0, 0.002, 3.0);
    EXPECT_NEAR(curvature.sd[0], std::sqrt(0.5 * 9.0 + 0.5 / 200.0), 1e-6);
    EXPECT_LE(curvature.sd[1], 3.0);
}

TEST(PeakCurvature, AtAnEndIsThatOfTheOtherSide) {
    const auto ends = [](const Point& at) {
        return at[0] > 0.0 ? -std::numeric_limits<double>::infinity() : -0.5 * 16.0 * at[0] * at[0];
    };
    const PeakCurvature curvature = peak_curvature(ends, {0.0}, 0.0, 0.002, 3.0);
    EXPECT_NEAR(curvature.sd[0], 0.25, 1e-9);
}

}  // namespace
}  // namespace gyrolog
