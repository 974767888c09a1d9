#include "analysis/diagnose/measures/narrow_lines.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/cross_axis.hpp"
#include "analysis/diagnose/measures/spectrum.hpp"
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

// What one half judges has no part in the other's fit.
TEST(HalvesOfMeasures, SayNothingOfTheOtherHalf) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, 30'000, 12);
    Recording changed = *recording;
    CosineTransform transform(changed.rows());
    std::vector<double> other = changed.find("gy")->values();
    transform.forward(other);
    Column& column = *std::ranges::find(changed.columns, std::string("gx"), &Column::name);
    std::vector<double> values = column.values();
    transform.forward(values);
    for (std::size_t k = 1; k < values.size(); ++k) {
        if (has_coefficient(Half::second, k)) { values[k] = 2.0 * values[k] + other[k]; }
    }
    transform.inverse(values);
    column.data = values;
    column.scale = 1.0;
    column.offset = 0.0;
    const auto half_curves = [&](const Recording& of, Half half) {
        const auto seen = std::make_shared<const Recording>(of);
        return gap_curves(Observation(prediction_of(seen, model)->of_half(half), seen, 1));
    };
    for (const Measure* measure : {&measures::spectrum, &measures::narrow, &measures::cross_axis}) {
        const auto differs = [&](Half half) {
            double most = 0.0;
            const std::vector<GapCurve> a = half_curves(*recording, half);
            const std::vector<GapCurve> b = half_curves(changed, half);
            const GapCurve& before = curve_of(a, *measure, 0);
            const GapCurve& after = curve_of(b, *measure, 0);
            for (std::size_t i = 0; i < before.value.size(); ++i) {
                most = std::max(most, std::fabs(before.value[i] - after.value[i]));
            }
            return most;
        };
        EXPECT_LT(differs(Half::first), 1e-3) << measure->name;
        EXPECT_GT(differs(Half::second), 0.1) << measure->name;
    }
}

}  // namespace
}  // namespace gyrolog
