#include "analysis/numerics/normal_scores.hpp"

#include <algorithm>
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

// The search begins near its end: between any two magnitudes, and on each, it ends where a search of all
// does.
TEST(NormalScores, AreThoseOfTheLargestMagnitudeThatIsNotAbove) {
    std::mt19937_64 random(3);
    std::student_t_distribution<double> tailed(1.5);
    std::vector<double> magnitudes(1000);
    for (double& x : magnitudes) { x = std::round(std::abs(tailed(random)) * 50.0) / 50.0; }
    const NormalScores scores(magnitudes);
    std::ranges::sort(magnitudes);
    for (std::size_t i = 1; i < magnitudes.size(); ++i) {
        const double here = scores.of(magnitudes[i]);
        EXPECT_EQ(scores.of(std::nextafter(magnitudes[i], 1e9)), here);
        const bool is_first = magnitudes[i - 1] < magnitudes[i];
        if (!is_first) { continue; }
        EXPECT_LT(scores.of(std::nextafter(magnitudes[i], 0.0)), here);
        EXPECT_EQ(scores.of(0.5 * (magnitudes[i - 1] + magnitudes[i])), scores.of(magnitudes[i - 1]));
    }
}

TEST(NormalScores, OfNothingAreZero) { EXPECT_EQ(NormalScores({}).of(3.0), 0.0); }

}  // namespace
}  // namespace gyrolog
