#include "analysis/diagnose/measures/amplitude.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

// The noise that is left of a sensor whose samples lean to one side.
TEST(AmplitudeCurve, HasSizesOnlyAndTheSkewnessApart) {
    const std::vector<GapCurve> curves = curves_of(3, [](std::vector<double>& codes) {
        const double sd_codes = white_sd_codes(codes);
        double mean = 0.0;
        for (const double code : codes) { mean += code / static_cast<double>(codes.size()); }
        for (double& code : codes) {
            const double z = (code - mean) / sd_codes;
            code = std::round(code + 0.15 * sd_codes * (z * z - 1.0));
        }
    });
    const GapCurve& tails = curve_of(curves, measures::amplitude, changed_axis);
    EXPECT_GT(tails.x.front(), 0.0) << "a size is reported as the gap's place";
    EXPECT_TRUE(std::ranges::is_sorted(tails.x));
    const GapCurve& skewness = curve_of(curves, measures::skewness, changed_axis);
    ASSERT_EQ(skewness.value.size(), 1U);
    // The third moment of z + 0.15 (z^2 - 1) is 0.9: some 80 standard deviations, less what rounding takes.
    EXPECT_GT(skewness.value.front(), 5.0);
    EXPECT_LT(std::fabs(curve_of(curves, measures::skewness, 1).value.front()), 4.5);
}

}  // namespace
}  // namespace gyrolog
