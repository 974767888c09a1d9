#include "analysis/numerics/tail_probability.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// With two degrees of freedom the chance to exceed v is exp(-v / 2).
TEST(SurpriseOfLargest, IsTheClosedFormForTwoDegrees) {
    EXPECT_NEAR(surprise_of_largest(9.0, 2.0, 1.0), 4.5, 1e-12);
    const double of_ten = 1.0 - std::pow(1.0 - std::exp(-4.5), 10.0);
    EXPECT_NEAR(surprise_of_largest(9.0, 2.0, 10.0), -std::log(of_ten), 1e-12);
}

TEST(SurpriseOfLargest, StaysFiniteWhereTheTailIsBelowTheSmallestDouble) {
    const double surprise = surprise_of_largest(1e5, 1.0, 1000.0);
    EXPECT_TRUE(std::isfinite(surprise));
    EXPECT_GT(surprise, 600.0);
}

TEST(DeviateOf, IsExceededWithTheChanceOfTheSurprise) {
    for (const double deviate : {-2.0, 0.0, 1.0, 2.326, 5.0, 9.0}) {
        const double chance = 0.5 * std::erfc(deviate / std::sqrt(2.0));
        EXPECT_NEAR(deviate_of(-std::log(chance)), deviate, 1e-9) << deviate;
    }
}

TEST(DeviateOf, KeepsWithinWhatADoubleCanTell) {
    EXPECT_EQ(deviate_of(0.0), deviate_of(0.005));
    EXPECT_EQ(deviate_of(1e4), deviate_of(700.0));
}

}  // namespace
}  // namespace gyrolog
