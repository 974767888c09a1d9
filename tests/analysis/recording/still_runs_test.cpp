#include "analysis/recording/still_runs.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

Recording recording_with(std::vector<Segment> segments, std::size_t rows) {
    Recording recording;
    recording.rate_hz = 100.0;
    recording.columns = {{"gx", "rad/s", Signal(rows, 0.0)}};
    recording.segments = std::move(segments);
    return recording;
}

Signal noise(std::size_t rows) {
    Signal x(rows);
    RandomStream(43, 0).normals(0, x);
    return x;
}

TEST(StillRuns, AreAllPartsWithoutMotion) {
    Signal x = noise(6000);
    for (std::size_t i = 1000; i < 1500; ++i) { x[i] += 20.0 * std::sin(0.05 * static_cast<double>(i)); }
    for (std::size_t i = 4000; i < 4300; ++i) { x[i] += 30.0; }
    const std::vector<Segment> runs =
        still_runs(recording_with({{0, 6000, 0}}, 6000), std::vector<Signal>{x});
    // The constant 30 from 40 to 43 s is a run of its own: nothing scatters in it.
    ASSERT_EQ(runs.size(), 4U);
    EXPECT_EQ(runs[0].first, 25U) << "the first block is an edge";
    EXPECT_NEAR(static_cast<double>(runs[0].count), 950.0, 25.0);
    EXPECT_NEAR(static_cast<double>(runs[1].first), 1525.0, 25.0);
    EXPECT_NEAR(static_cast<double>(runs[2].first), 4025.0, 25.0);
    EXPECT_NEAR(static_cast<double>(runs[3].first), 4325.0, 25.0);
}

TEST(StillRuns, EndAtAHole) {
    const std::vector<Segment> runs =
        still_runs(recording_with({{0, 500, 10}, {500, 500, 600}}, 1000), std::vector<Signal>{noise(1000)});
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_EQ(runs[0].first_index, 35);
    EXPECT_EQ(runs[1].first_index, 625);
}

TEST(StillRuns, AreThereWhereCountsHardlyChange) {
    Signal x(2000, 1.0);
    x[700] = 2.0;
    EXPECT_FALSE(still_runs(recording_with({{0, 2000, 0}}, 2000), std::vector<Signal>{x}).empty());
}

TEST(StillRuns, AreNoneOfAFewSamples) {
    EXPECT_TRUE(still_runs(recording_with({{0, 40, 0}}, 40), std::vector<Signal>{noise(40)}).empty());
    EXPECT_TRUE(still_runs(recording_with({}, 0), std::vector<Signal>{Signal{}}).empty());
}

}  // namespace
}  // namespace gyrolog
