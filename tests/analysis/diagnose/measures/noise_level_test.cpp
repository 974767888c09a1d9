#include "analysis/diagnose/measures/noise_level.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

TEST(NoiseLevelCurves, OfOrdinaryNoiseAreSmall) {
    constexpr std::uint64_t seeds = 12;
    std::size_t large = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const std::vector<GapCurve> curves = curves_of(seed, {});
        for (const double value : curve_of(curves, measures::memory, 0).value) {
            EXPECT_LT(std::fabs(value), 1.5) << "seed " << seed;
        }
        for (const double value : shared_curve_of(curves, measures::memory).value) {
            EXPECT_LT(std::fabs(value), 1.5) << "seed " << seed;
        }
        large += most(shared_curve_of(curves, measures::rhythm)) > 2.326 ? 1U : 0U;
    }
    // One of a hundred in each of some seven octaves: six of twelve come once in ten thousand times.
    EXPECT_LE(large, 5U);
}

TEST(NoiseLevelCurves, ShowNoiseInBurstsOfOneLength) {
    constexpr std::size_t burst = 64;
    const std::vector<GapCurve> curves = curves_of(5, [](std::vector<double>& codes) {
        std::mt19937_64 random(2);
        std::bernoulli_distribution loud(0.5);
        double factor = 1.0;
        scale_noise(codes, [&](std::size_t i) {
            if (i % burst == 0) { factor = loud(random) ? std::sqrt(1.3) : std::sqrt(0.7); }
            return factor;
        });
    });
    const GapCurve& memory = curve_of(curves, measures::memory, changed_axis);
    const GapCurve& quiet = curve_of(curves, measures::memory, 1);
    // Blocks of m samples have 2/m for themselves and 0.3^2 of the bursts.
    const auto at = static_cast<std::size_t>(std::log2(burst));
    EXPECT_NEAR(std::pow(1.0 + memory.value[at], 3.0), 1.0 + 0.09 * burst / (2.0 * 1.135), 0.6);
    EXPECT_NEAR(quiet.value[at], 0.0, 0.15);
}

// Too faint for any axis alone.
TEST(NoiseLevelCurves, ShowBurstsThatAllAxesShare) {
    constexpr std::size_t burst = 256;
    const std::vector<GapCurve> curves =
        curves_of(6,
                  [](std::vector<double>& codes) {
                      std::mt19937_64 random(7);
                      std::bernoulli_distribution loud(0.5);
                      double factor = 1.0;
                      scale_noise(codes, [&](std::size_t i) {
                          if (i % burst == 0) { factor = loud(random) ? std::sqrt(1.1) : std::sqrt(0.9); }
                          return factor;
                      });
                  },
                  {0, 1, 2});
    const auto at = static_cast<std::size_t>(std::log2(burst));
    const double alone = curve_of(curves, measures::memory, 1).value[at];
    const double shared = shared_curve_of(curves, measures::memory).value[at];
    EXPECT_NEAR(std::pow(1.0 + shared, 3.0) - 1.0, 3.0 * (0.01 * burst / (2.0 * 1.135)), 1.0);
    EXPECT_GT(shared, 1.5 * alone);
}

TEST(NoiseLevelCurves, ShowNoiseThatSwellsEverySoOften) {
    constexpr std::size_t every = 7300;
    constexpr std::size_t length = 800;
    const std::vector<GapCurve> curves =
        curves_of(5,
                  [](std::vector<double>& codes) {
                      scale_noise(codes, [&](std::size_t i) { return i % every < length ? 1.06 : 1.0; });
                  },
                  {0, 1, 2});
    const GapCurve& rhythm = shared_curve_of(curves, measures::rhythm);
    const auto peak = static_cast<std::size_t>(std::ranges::max_element(rhythm.value) - rhythm.value.begin());
    EXPECT_GT(most(rhythm), 5.5);
    EXPECT_NEAR(rhythm.x[peak], static_cast<double>(every) / 100.0, 0.5);
    EXPECT_TRUE(std::ranges::is_sorted(rhythm.x));
}

}  // namespace
}  // namespace gyrolog
