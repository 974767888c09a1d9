#include "analysis/numerics/normal_scores.hpp"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {
namespace {

TEST(NormalScores, AreTheQuantilesOfTheHalfNormalDistribution) {
    std::vector<double> magnitudes(99);
    std::iota(magnitudes.begin(), magnitudes.end(), 1.0);
    const NormalScores scores(magnitudes);
    EXPECT_NEAR(scores.of(50.0), normal_quantile(0.75), 1e-12);  // the median of |z|
    EXPECT_NEAR(scores.of(99.0), normal_upper_quantile(0.5 * 0.5 / 99.0), 1e-12);
    EXPECT_EQ(scores.of(1e9), scores.of(99.0));
    EXPECT_EQ(scores.of(0.0), scores.of(1.0));
}

// However heavy the tail is: Cauchy's has no variance.
TEST(NormalScores, HaveAVarianceOfOne) {
    std::mt19937_64 random(1);
    std::cauchy_distribution<double> cauchy;
    std::vector<double> magnitudes(5000);
    for (double& x : magnitudes) { x = std::abs(cauchy(random)); }
    const NormalScores scores(magnitudes);
    double squares = 0.0;
    for (const double x : magnitudes) { squares += scores.of(x) * scores.of(x); }
    EXPECT_NEAR(squares / 5000.0, 1.0, 2e-3);  // the half rank at the end takes 1e-3
}

TEST(NormalScores, OfEqualNumbersAreThatOfTheirMiddle) {
    const NormalScores scores({0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0});
    EXPECT_NEAR(scores.of(1.0), normal_upper_quantile(0.5 * (1.0 - 6.0 / 10.0)), 1e-12);
    EXPECT_LT(scores.of(0.5), scores.of(1.0));
    EXPECT_GE(scores.of(0.5), scores.of(0.0));
}

TEST(NormalScores, OfNothingAreZero) { EXPECT_EQ(NormalScores({}).of(3.0), 0.0); }

}  // namespace
}  // namespace gyrolog
