#include "analysis/recording/recording.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/recording/recording_with_holes.hpp"

namespace gyrolog {
namespace {

TEST(FirstRows, EndTheRecordingAndNothingElse) {
    for (std::size_t rows = 1; rows <= 10; ++rows) {
        SCOPED_TRACE(rows);
        const Recording whole = with_holes();
        const Recording part = first_rows(with_holes(), rows);
        EXPECT_EQ(part.rows(), rows);
        EXPECT_EQ(part.t_s.size(), rows);
        std::size_t in_segments = 0;
        for (const Segment& segment : part.segments) { in_segments += segment.count; }
        EXPECT_EQ(in_segments, rows);
        EXPECT_EQ(part.columns[0].value(rows - 1), whole.columns[0].value(rows - 1));
        std::int64_t missing = 0;
        for (const Dropout& dropout : part.dropouts) { missing += dropout.samples; }
        EXPECT_EQ(missing, part.missing_samples());
        EXPECT_NEAR(part.duration_s(), whole.t_s[rows - 1] + 0.1, 1e-12);
    }
}

TEST(FirstRows, OfMoreThanThereAreIsTheWhole) {
    const Recording part = first_rows(with_holes(), 11);
    EXPECT_EQ(part.rows(), 10U);
    EXPECT_EQ(part.missing_samples(), 5);
}

TEST(MeansOf, AreOfWholeGroupsOnTheGrid) {
    const Recording means = means_of(with_holes(), 2);
    // Instants 0-3, 5-6 and 11-14 in pairs from 0 on: 5 has no partner, nor has 6, 11 and 14.
    ASSERT_EQ(means.rows(), 3U);
    EXPECT_EQ(means.columns[0].values(), (std::vector<double>{0.5, 2.5, 7.5}));
    ASSERT_EQ(means.segments.size(), 2U);
    EXPECT_EQ(means.segments[0].count, 2U);
    EXPECT_EQ(means.segments[1].first, 2U);
    EXPECT_EQ(means.segments[1].first_index, 6);
    EXPECT_EQ(means.rate_hz, 5.0);
    EXPECT_EQ(means.samples_per_row, 2U);
    EXPECT_EQ(means_of(means, 2).samples_per_row, 4U);
}

TEST(MeansOf, AreOfWhatIsKnown) {
    Recording recording = with_holes();
    auto& values = std::get<1>(recording.columns[0].data);
    values[0] = std::nan("");
    values[2] = values[3] = std::nan("");
    const std::vector<double> means = means_of(recording, 2).columns[0].values();
    EXPECT_EQ(means[0], 1.0);
    EXPECT_TRUE(std::isnan(means[1]));
}

// Counted from the first sample there is.
TEST(MeansOf, BeginWithTheFirstSample) {
    Recording recording = with_holes();
    for (Segment& segment : recording.segments) { segment.first_index += 7; }
    EXPECT_EQ(means_of(recording, 2).columns[0].values(), means_of(with_holes(), 2).columns[0].values());
}

}  // namespace
}  // namespace gyrolog
