#include "analysis/recording/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<double> stamps(std::size_t count, double rate_hz, double jitter_s, std::uint64_t seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<double> t_s;
    for (std::size_t i = 0; i < count; ++i) {
        t_s.push_back(5.0 + static_cast<double>(i) / rate_hz + jitter_s * normal(random));
    }
    return t_s;
}

std::vector<std::int64_t> missing_in(const Grid& grid) {
    std::vector<std::int64_t> all;
    for (const Dropout& dropout : grid.dropouts) { all.push_back(dropout.samples); }
    return all;
}

TEST(Grid, OfSamplingStampsHasTheirRateWithinItsUncertainty) {
    int within_three_sigma = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Grid grid = grid_from_stamps(stamps(5000, 99.32, 2e-4, seed));
        EXPECT_EQ(grid.stamps, StampKind::sampling);
        EXPECT_THAT(grid.dropouts, IsEmpty());
        EXPECT_NEAR(*grid.stamp_jitter_s, 2e-4, 2e-5);
        if (std::abs(grid.rate_hz - 99.32) < 3.0 * *grid.rate_sd_hz) { ++within_three_sigma; }
        EXPECT_LT(*grid.rate_sd_hz, 2e-4);
    }
    EXPECT_GE(within_three_sigma, 47);
}

TEST(Grid, FindsEveryDropoutAndItsLength) {
    std::vector<double> t_s = stamps(10000, 1000.0, 5e-5);
    t_s.erase(t_s.begin() + 7000, t_s.begin() + 7500);
    t_s.erase(t_s.begin() + 6003, t_s.begin() + 6004);
    t_s.erase(t_s.begin() + 100, t_s.begin() + 112);
    const Grid grid = grid_from_stamps(t_s);
    EXPECT_THAT(missing_in(grid), ElementsAre(12, 1, 500));
    EXPECT_NEAR(grid.dropouts[0].at_s, 0.100, 1e-6);
    EXPECT_NEAR(grid.dropouts[2].at_s, 7.000, 1e-5);
    ASSERT_THAT(grid.segments, SizeIs(4));
    EXPECT_EQ(grid.segments[3].first_index, 7500);
    EXPECT_EQ(grid.segments[3].first, t_s.size() - grid.segments[3].count);
    EXPECT_NEAR(grid.rate_hz, 1000.0, 0.01);
}

TEST(Grid, TakesALateStampForNoDropout) {
    std::vector<double> t_s = stamps(1000, 100.0, 1e-5);
    t_s[400] += 0.009;
    t_s[700] += 0.007;
    const Grid grid = grid_from_stamps(t_s);
    EXPECT_EQ(grid.stamps, StampKind::sampling);
    EXPECT_THAT(grid.dropouts, IsEmpty());
}

TEST(Grid, IsNotMisledByStampsRoundedToMilliseconds) {
    std::vector<double> t_s;
    for (int i = 0; i < 20000; ++i) { t_s.push_back(std::floor(i / 0.2857143) / 1000.0); }
    const Grid grid = grid_from_stamps(t_s);
    EXPECT_EQ(grid.stamps, StampKind::sampling);
    EXPECT_THAT(grid.dropouts, IsEmpty());
    EXPECT_NEAR(grid.rate_hz, 285.7143, 1e-3);
}

// Holes longer than all that was recorded: one of an hour, or a logger that wakes for a minute in ten.
TEST(Grid, OfStretchesWithLongHolesKeepsTheRate) {
    for (const auto& [stretches, stretch_s, hole_s] :
         {std::array{2.0, 1200.0, 3600.0}, {10.0, 60.0, 540.3}}) {
        std::vector<double> t_s;
        for (double stretch = 0.0; stretch < stretches; ++stretch) {
            for (double i = 0.0; i < stretch_s * 50.0; ++i) {
                t_s.push_back(stretch * (stretch_s + hole_s) + i / 50.0);
            }
        }
        const Grid grid = grid_from_stamps(t_s);
        EXPECT_EQ(grid.stamps, StampKind::sampling);
        EXPECT_NEAR(grid.rate_hz, 50.0, 1e-4);
        ASSERT_EQ(static_cast<double>(grid.segments.size()), stretches);
        EXPECT_NEAR(static_cast<double>(missing_in(grid).front()), hole_s * 50.0, 2.0);
    }
}

// Bursts as a serial port makes them: four of five samples arrive 2 ms after each other, then nothing for 42
// ms.
TEST(Grid, OfBurstsGivesTheMeanRateOnly) {
    std::vector<double> t_s;
    for (int i = 0; i < 20000; ++i) {
        const int burst = i / 5;
        t_s.push_back(0.05 * burst + 0.002 * (i % 5));
    }
    const Grid grid = grid_from_stamps(t_s);
    EXPECT_EQ(grid.stamps, StampKind::arrival);
    EXPECT_NEAR(grid.rate_hz, 100.0, 0.01);
    EXPECT_THAT(grid.dropouts, IsEmpty());
    EXPECT_THAT(grid.warnings, ElementsAre(HasSubstr("arrival times")));
}

TEST(Grid, OfBurstsIsNotMisledByAStallOfTheHost) {
    std::vector<double> t_s;
    for (int i = 0; i < 20000; ++i) {
        const int burst = i / 5;
        t_s.push_back(0.05 * burst + 0.002 * (i % 5));
    }
    for (int i = 19960; i < 20000; ++i) { t_s[static_cast<std::size_t>(i)] = 200.4 + 0.0001 * (i - 19960); }
    EXPECT_NEAR(grid_from_stamps(t_s).rate_hz, 100.0, 0.005);
}

TEST(Grid, OfStampsThatRepeatIsOneOfArrivals) {
    std::vector<double> t_s = stamps(1000, 100.0, 0.0);
    t_s[500] = t_s[499];
    const Grid grid = grid_from_stamps(t_s);
    EXPECT_EQ(grid.stamps, StampKind::arrival);
    EXPECT_THAT(grid.warnings.front(), HasSubstr("1 of 1000 time stamps repeat"));
}

TEST(Grid, FailsWhereTheClockWasSetBack) {
    std::vector<double> t_s = stamps(1000, 100.0, 0.0);
    for (std::size_t i = 600; i < 1000; ++i) { t_s[i] -= 5.0; }
    EXPECT_THAT(grid_from_stamps(t_s).failure, HasSubstr("row 601"));
}

TEST(Grid, FailsWithoutTwoStampsThatRise) {
    EXPECT_NE(grid_from_stamps({}).failure, "");
    EXPECT_NE(grid_from_stamps(std::vector<double>{1.0}).failure, "");
    EXPECT_NE(grid_from_stamps(std::vector<double>(10, 1.0)).failure, "");
}

TEST(Grid, OfTwoOrThreeStampsGoesThroughThem) {
    EXPECT_NEAR(grid_from_stamps(std::vector<double>{1.0, 1.01}).rate_hz, 100.0, 1e-9);
    EXPECT_NEAR(grid_from_stamps(std::vector<double>{1.0, 1.01, 1.02}).rate_hz, 100.0, 1e-9);
}

TEST(Grid, KeepsMissingRowsAtTheirTruePlace) {
    Grid grid = grid_from_rate(10, 10.0);
    std::vector<bool> present(10, true);
    present[0] = present[3] = present[4] = present[9] = false;
    punch_holes(grid, present);
    ASSERT_THAT(grid.segments, SizeIs(2));
    EXPECT_EQ(grid.segments[0].first_index, 1);
    EXPECT_EQ(grid.segments[0].count, 2U);
    EXPECT_EQ(grid.segments[1].first_index, 5);
    EXPECT_EQ(grid.segments[1].first, 2U);
    EXPECT_EQ(grid.segments[1].count, 4U);
    ASSERT_THAT(grid.dropouts, SizeIs(1));
    EXPECT_EQ(grid.dropouts[0].samples, 2);
    EXPECT_EQ(grid.dropouts[0].cause, "empty_fields");
    EXPECT_NEAR(grid.dropouts[0].at_s, 0.2, 1e-12);
}

}  // namespace
}  // namespace gyrolog
