#include "analysis/noise/gravity.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

AxisMean mean_of(double value, double standard_uncertainty, double dof = 0.0) {
    AxisMean axis;
    axis.mean.value = value;
    axis.mean.coverage_factor = 2.0;
    axis.mean.expanded_uncertainty = 2.0 * standard_uncertainty;
    axis.dof = dof;
    return axis;
}

TEST(Gravity, OfALevelSensorIsItsOneAxisAndHasNoTilt) {
    const Gravity gravity = gravity_of({mean_of(0.0, 0.02), mean_of(0.0, 0.03), mean_of(-9.8, 0.01)});
    EXPECT_DOUBLE_EQ(gravity.size.value, 9.8);
    EXPECT_NEAR(gravity.size.expanded_uncertainty, 2.0 * 0.01, 1e-12);
    EXPECT_STREQ(gravity.up_name(), "-z");
    EXPECT_EQ(gravity.tilt_rad.value, 0.0);
    EXPECT_NEAR(gravity.tilt_rad.expanded_uncertainty, 2.0 * 0.03 / 9.8, 1e-12);
}

TEST(Gravity, TiltIsTheAngleToTheAxisNearestToTheVertical) {
    const double tilt_rad = 0.3;
    const Gravity gravity =
        gravity_of({mean_of(10.0 * std::cos(tilt_rad), 0.0), mean_of(6.0 * std::sin(tilt_rad), 0.0),
                    mean_of(8.0 * std::sin(tilt_rad), 0.0)});
    EXPECT_STREQ(gravity.up_name(), "+x");
    EXPECT_NEAR(gravity.size.value, 10.0, 1e-12);
    EXPECT_NEAR(gravity.tilt_rad.value, tilt_rad, 1e-12);
    EXPECT_NEAR(gravity.direction[1], 0.6 * std::sin(tilt_rad), 1e-12);
}

TEST(Gravity, ATiltIsKnownToHalfATurnAtWorst) {
    const Gravity gravity = gravity_of({mean_of(0.1, 9.0), mean_of(0.2, 9.0), mean_of(0.3, 9.0)});
    EXPECT_EQ(gravity.tilt_rad.expanded_uncertainty, pi);
}

TEST(Gravity, OfAFreeFallIsNothing) {
    const Gravity gravity = gravity_of({mean_of(0.0, 0.1), mean_of(0.0, 0.1), mean_of(0.0, 0.1)});
    EXPECT_EQ(gravity.size.value, 0.0);
    EXPECT_EQ(gravity.tilt_rad.value, 0.0);
}

TEST(Gravity, AnUncertaintyThatIsKnownBadlyHasALargerFactor) {
    const Gravity known = gravity_of({mean_of(1.0, 0.1), mean_of(2.0, 0.1), mean_of(9.0, 0.1)});
    EXPECT_DOUBLE_EQ(known.size.coverage_factor, 2.0);
    // All of it from one axis: its own degrees of freedom.
    const Gravity badly = gravity_of({mean_of(1.0, 0.0), mean_of(2.0, 0.0), mean_of(9.0, 0.1, 5.0)});
    EXPECT_NEAR(badly.size.coverage_factor, coverage_factor(5.0), 1e-9);
    EXPECT_GT(badly.size.coverage_factor, 2.5);
    // The squares of three equal ones average: three times the degrees of freedom.
    const Gravity three =
        gravity_of({mean_of(5.0, 0.1, 5.0), mean_of(5.0, 0.1, 5.0), mean_of(5.0, 0.1, 5.0)});
    EXPECT_NEAR(three.size.coverage_factor, coverage_factor(15.0), 1e-9);
}

// 95.45 % of the intervals hold the truth, to four standard deviations of 4000 draws.
TEST(Gravity, IntervalsOfSizeAndTiltHoldTheTruth) {
    constexpr int draws = 4000;
    constexpr double truth[] = {1.2, -0.7, 9.7};
    constexpr double sd[] = {0.02, 0.05, 0.03};
    const Gravity exact =
        gravity_of({mean_of(truth[0], 0.0), mean_of(truth[1], 0.0), mean_of(truth[2], 0.0)});
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    int size_inside = 0;
    int tilt_inside = 0;
    for (int draw = 0; draw < draws; ++draw) {
        std::array<AxisMean, 3> axes;
        for (std::size_t i = 0; i < 3; ++i) { axes[i] = mean_of(truth[i] + sd[i] * normal(random), sd[i]); }
        const Gravity seen = gravity_of(axes);
        const auto holds = [](const ExpandedNumber& number, double value) {
            return std::abs(number.value - value) <= number.expanded_uncertainty ? 1 : 0;
        };
        size_inside += holds(seen.size, exact.size.value);
        tilt_inside += holds(seen.tilt_rad, exact.tilt_rad.value);
    }
    const double allowed = 4.0 * std::sqrt(0.9545 * 0.0455 / draws);
    EXPECT_NEAR(static_cast<double>(size_inside) / draws, 0.9545, allowed);
    EXPECT_NEAR(static_cast<double>(tilt_inside) / draws, 0.9545, allowed);
}

}  // namespace
}  // namespace gyrolog
