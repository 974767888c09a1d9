#include "analysis/numerics/golden_section.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(GoldenSection, FindsATopThatIsNoParabola) {
    const auto fall = [](double x) { return std::log(x) - x / 3.0; };
    EXPECT_NEAR(place_of_top(fall, 0.1, 50.0), 3.0, 1e-5 * 50.0);
}

TEST(GoldenSection, StaysAtTheEndWhereTheFunctionRises) {
    EXPECT_NEAR(place_of_top([](double x) { return x; }, -2.0, 5.0), 5.0, 1e-5 * 7.0);
    EXPECT_NEAR(place_of_top([](double x) { return -x; }, -2.0, 5.0), -2.0, 1e-5 * 7.0);
    EXPECT_EQ(place_of_top([](double x) { return -x * x; }, 1.5, 1.5), 1.5);
}

// 0.618 each time: 24 shorten the distance to a hundred thousandth, with two to begin with.
TEST(GoldenSection, AsksForOneValueAStep) {
    int asked = 0;
    place_of_top(
        [&](double x) {
            ++asked;
            return -std::fabs(x - 0.3);
        },
        0.0, 1.0);
    EXPECT_EQ(asked, 26);
}

}  // namespace
}  // namespace gyrolog
