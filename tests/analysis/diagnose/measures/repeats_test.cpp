#include "analysis/diagnose/measures/repeats.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(RepeatsCurve, ShowsSamplesThatStick) {
    const std::vector<GapCurve> curves = curves_of(3, [](std::vector<double>& codes) {
        std::mt19937_64 random(1);
        std::bernoulli_distribution sticks(0.01);
        for (std::size_t i = 1; i < codes.size(); ++i) {
            if (sticks(random)) { codes[i] = codes[i - 1]; }
        }
    });
    const GapCurve& repeats = curve_of(curves, measures::repeats, changed_axis);
    EXPECT_GT(repeats.value[0], 5.0);
    EXPECT_EQ(repeats.x, (std::vector<double>{1.0, 2.0}));
    EXPECT_FALSE(measures::repeats.is_course);
    EXPECT_LT(std::fabs(repeats.value[1]), 4.5);
    EXPECT_LT(std::fabs(curve_of(curves, measures::repeats, 1).value[0]), 4.5);
}

}  // namespace
}  // namespace gyrolog
