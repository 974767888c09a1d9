#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/codes.hpp"
#include "analysis/diagnose/measures/narrow_lines.hpp"
#include "analysis/diagnose/measures/period.hpp"
#include "analysis/diagnose/measures/repeats.hpp"
#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(StructureCurves, OfOrdinaryNoiseAreRarelyLarge) {
    constexpr std::uint64_t seeds = 12;
    double count = 0.0;
    double large = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const std::vector<GapCurve> curves = curves_of(seed, {});
        for (const Measure* measure :
             {&measures::repeats, &measures::period, &measures::narrow, &measures::codes}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const double value : curve_of(curves, *measure, axis).value) {
                    EXPECT_LT(value, 4.9) << "seed " << seed;  // 1 of two millions
                    large += value > 2.326;
                    count += 1.0;
                }
            }
        }
    }
    // One of a hundred by the normal distribution, and four standard deviations of that number.
    EXPECT_LT(large, 0.01 * count + 4.0 * std::sqrt(0.01 * count));
}

TEST(StructureCurves, HaveAsManyPointsWhateverIsJudged) {
    SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, samples, 1);
    const std::vector<GapCurve> whole =
        gap_curves(Observation(prediction_of(recording, model), recording, 1));
    // Of a sensor known to be read too fast, the samples that repeat are not judged.
    EffectModel stale;
    stale.effect = "stale";
    stale.params = {{"eps", 0.45}};
    model.effects = {stale};
    const auto repeating = recorded(model, samples, 1);
    const std::vector<GapCurve> part = gap_curves(Observation(prediction_of(repeating, model), repeating, 1));
    ASSERT_EQ(part.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(part[i].value.size(), whole[i].value.size()) << i;
        for (const double value : part[i].value) { EXPECT_TRUE(std::isfinite(value)) << i; }
    }
}

TEST(StructureCurves, ShowSamplesThatStick) {
    const std::vector<GapCurve> curves = curves_of(3, [](std::vector<double>& codes) {
        std::mt19937_64 random(1);
        std::bernoulli_distribution sticks(0.01);
        for (std::size_t i = 1; i < codes.size(); ++i) {
            if (sticks(random)) { codes[i] = codes[i - 1]; }
        }
    });
    const GapCurve& repeats = curve_of(curves, measures::repeats, changed_axis);
    EXPECT_GT(repeats.value[0], 5.0);
    EXPECT_LT(std::fabs(repeats.value[1]), 4.5);
    EXPECT_LT(std::fabs(curve_of(curves, measures::repeats, 1).value[0]), 4.5);
}

TEST(StructureCurves, ShowWhatComesBackTooFaintToSeeOnce) {
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

TEST(StructureCurves, ShowALineThatWandersAndWhere) {
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

TEST(StructureCurves, ShowASlowSwingBelowTheBandsOfLines) {
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

TEST(StructureCurves, ShowACodeThatIsNeverShown) {
    const std::vector<GapCurve> curves = curves_of(8, [](std::vector<double>& codes) {
        const double level = std::round(codes.front()) + 4.0;
        for (double& code : codes) { code += code == level ? 1.0 : 0.0; }
    });
    const GapCurve& changed = curve_of(curves, measures::codes, changed_axis);
    const GapCurve& ordinary = curve_of(curves, measures::codes, 1);
    EXPECT_GT(changed.value[0], 10.0);
    EXPECT_LT(ordinary.value[0], 4.5);
    EXPECT_LT(ordinary.value[1], 4.5);
}

// Where a code is expected some twenty times.
TEST(StructureCurves, ShowACodeInTheTailThatIsNeverShown) {
    const std::vector<GapCurve> curves = curves_of(8, [](std::vector<double>& codes) {
        std::vector<double> sorted = codes;
        std::ranges::sort(sorted);
        const double level = sorted[sorted.size() - 30];
        for (double& code : codes) { code += code == level ? 1.0 : 0.0; }
    });
    EXPECT_GT(curve_of(curves, measures::codes, changed_axis).value[0], 4.9);
}

TEST(StructureCurves, ShowAConverterWhoseLowestBitIsWeak) {
    const std::vector<GapCurve> curves = curves_of(9, [](std::vector<double>& codes) {
        std::mt19937_64 random(4);
        std::bernoulli_distribution misses(0.05);
        for (double& code : codes) {
            if (std::fmod(code, 2.0) != 0.0 && misses(random)) { code -= 1.0; }
        }
    });
    EXPECT_GT(curve_of(curves, measures::codes, changed_axis).value[1], 10.0);
}

TEST(StructureCurves, JudgeCodesOfASensorAtRestOnly) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, 20'000, 10, tumbling_world(5.0));
    const auto prediction = prediction_of(recording, model);
    ASSERT_TRUE(prediction->moves());
    const std::vector<GapCurve> curves = gap_curves(Observation(prediction, recording, 1));
    EXPECT_EQ(curve_of(curves, measures::codes, 0).value, (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace gyrolog
