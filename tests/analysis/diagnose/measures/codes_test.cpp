#include "analysis/diagnose/measures/codes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(CodesCurve, ShowsACodeThatIsNeverShown) {
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

TEST(CodesCurve, ShowsACodeInTheTailThatIsNeverShown) {
    const std::vector<GapCurve> curves = curves_of(8, [](std::vector<double>& codes) {
        std::vector<double> sorted = codes;
        std::ranges::sort(sorted);
        const double level = sorted[sorted.size() - 30];
        for (double& code : codes) { code += code == level ? 1.0 : 0.0; }
    });
    EXPECT_GT(curve_of(curves, measures::codes, changed_axis).value[0], 4.9);
}

TEST(CodesCurve, ShowsAConverterWhoseLowestBitIsWeak) {
    const std::vector<GapCurve> curves = curves_of(9, [](std::vector<double>& codes) {
        std::mt19937_64 random(4);
        std::bernoulli_distribution misses(0.05);
        for (double& code : codes) {
            if (std::fmod(code, 2.0) != 0.0 && misses(random)) { code -= 1.0; }
        }
    });
    EXPECT_GT(curve_of(curves, measures::codes, changed_axis).value[1], 10.0);
}

// Where the noise is less than a code, the bias alone says whether the code is even.
TEST(CodesCurve, TakesNoBalanceForGrantedWhereTheNoiseIsLessThanACode) {
    const std::vector<GapCurve> curves = curves_of(11, [](std::vector<double>& codes) {
        std::mt19937_64 random(6);
        std::normal_distribution<double> noise(0.2, 0.3);
        for (double& code : codes) { code = std::round(noise(random)); }
    });
    EXPECT_LT(curve_of(curves, measures::codes, changed_axis).value[1], 3.0);
}

TEST(CodesCurve, JudgesCodesOfASensorAtRestOnly) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, 20'000, 10, tumbling_world(5.0));
    const auto prediction = prediction_of(recording, model);
    ASSERT_TRUE(prediction->moves());
    const std::vector<GapCurve> curves = gap_curves(Observation(prediction, recording, 1));
    EXPECT_EQ(curve_of(curves, measures::codes, 0).value, (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace gyrolog
