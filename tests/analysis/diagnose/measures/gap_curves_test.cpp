#include "analysis/diagnose/measures/gap_curves.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/codes.hpp"
#include "analysis/diagnose/measures/narrow_lines.hpp"
#include "analysis/diagnose/measures/period.hpp"
#include "analysis/diagnose/measures/repeats.hpp"
#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(GapCurves, OfOrdinaryNoiseAreRarelyLarge) {
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

TEST(GapCurves, HaveAsManyPointsWhateverIsJudged) {
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

}  // namespace
}  // namespace gyrolog
