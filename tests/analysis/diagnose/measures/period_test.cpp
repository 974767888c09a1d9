#include "analysis/diagnose/measures/period.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/narrow_lines.hpp"
#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(PeriodCurve, ShowsWhatComesBackTooFaintToSeeOnce) {
    constexpr std::size_t every = 390;
    const std::vector<GapCurve> curves = curves_of(4, [](std::vector<double>& codes) {
        const double height = 1.3 * white_sd_codes(codes);
        for (std::size_t i = 9; i < codes.size(); i += every) { codes[i] += std::round(height); }
    });
    const GapCurve& period = curve_of(curves, measures::period, changed_axis);
    const auto peak = std::ranges::max_element(period.value) - period.value.begin();
    EXPECT_GT(most(period), 6.0);
    // Within the octave, or one above for its multiple.
    EXPECT_NEAR(std::log2(period.x[static_cast<std::size_t>(peak)] * 100.0 / every), 0.5, 1.0);
    EXPECT_LT(most(curve_of(curves, measures::period, 1)), 4.5);
    // Neither its tails nor a line say so.
    EXPECT_LT(most(curve_of(curves, measures::narrow, changed_axis)), 4.5);
}

}  // namespace
}  // namespace gyrolog
