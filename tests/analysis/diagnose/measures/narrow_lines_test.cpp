#include "analysis/diagnose/measures/narrow_lines.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(NarrowLines, ShowALineThatWandersAndWhere) {
    constexpr double f_hz = 31.0;
    const std::vector<GapCurve> curves = curves_of(6, [](std::vector<double>& codes) {
        std::mt19937_64 random(3);
        std::normal_distribution<double> step_rad(0.0, 0.05);
        const double height = 0.12 * white_sd_codes(codes);
        double phase_rad = 0.0;
        for (std::size_t i = 0; i < codes.size(); ++i) {
            phase_rad += step_rad(random);
            codes[i] +=
                height * std::sin(2.0 * 3.14159265358979 * f_hz * static_cast<double>(i) / 100.0 + phase_rad);
        }
    });
    const GapCurve& narrow = curve_of(curves, measures::narrow, changed_axis);
    const auto peak = std::ranges::max_element(narrow.value) - narrow.value.begin();
    EXPECT_GT(most(narrow), 6.0);
    EXPECT_NEAR(narrow.x[static_cast<std::size_t>(peak)], f_hz, 0.3);
    EXPECT_LT(most(curve_of(curves, measures::narrow, 1)), 4.5);
}

TEST(NarrowLines, ShowASlowSwingBelowTheBandsOfLines) {
    constexpr double f_hz = 1.0 / 80.0;  // 15 turns
    const std::vector<GapCurve> curves = curves_of(7, [](std::vector<double>& codes) {
        const double height = 0.08 * white_sd_codes(codes);
        for (std::size_t i = 0; i < codes.size(); ++i) {
            codes[i] += height * std::sin(2.0 * 3.14159265358979 * f_hz * static_cast<double>(i) / 100.0);
        }
    });
    const GapCurve& narrow = curve_of(curves, measures::narrow, changed_axis);
    EXPECT_GT(narrow.value.front(), 6.0);
    EXPECT_NEAR(narrow.x.front(), f_hz, 0.2 * f_hz);
    EXPECT_LT(curve_of(curves, measures::narrow, 1).value.front(), 4.5);
}

}  // namespace
}  // namespace gyrolog
