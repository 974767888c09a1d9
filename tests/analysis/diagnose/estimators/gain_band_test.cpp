#include "analysis/diagnose/estimators/gain_band.hpp"

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// The Allan deviation looks at f = 0.37 / tau.
TEST(GainBand, FastNoiseShowsAtShortAveragingTimes) {
    const Span times_s = averaging_times_of({0.37, 3.7});
    EXPECT_NEAR(times_s.from, 0.1, 1e-12);
    EXPECT_NEAR(times_s.to, 1.0, 1e-12);
}

TEST(GainBand, AveragingTimesEndWhereTheRecordingDoes) {
    const Span times_s = averaging_times_of({1e-3, 2e-3}, 219.0);
    EXPECT_NEAR(times_s.from, 185.0, 1e-9);
    EXPECT_EQ(times_s.to, 219.0);
    // All of a band may lie beyond: the times are never in the wrong order.
    const Span beyond_s = averaging_times_of({1e-4, 2e-4}, 219.0);
    EXPECT_EQ(beyond_s.from, 219.0);
    EXPECT_EQ(beyond_s.to, 219.0);
}

}  // namespace
}  // namespace gyrolog
