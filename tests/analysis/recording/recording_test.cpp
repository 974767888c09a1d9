#include "analysis/recording/recording.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// Ten rows in three segments: 0-3, then one missing, 4-5, then four missing, 6-9.
Recording with_holes() {
    Recording recording;
    recording.rate_hz = 10.0;
    Column column{.name = "gx", .unit = "rad/s", .data = std::vector<double>(10)};
    std::iota(std::get<1>(column.data).begin(), std::get<1>(column.data).end(), 0.0);
    recording.columns = {column};
    recording.t_s = {0.0, 0.1, 0.2, 0.3, 0.5, 0.6, 1.1, 1.2, 1.3, 1.4};
    recording.segments = {{0, 4, 0}, {4, 2, 5}, {6, 4, 11}};
    recording.dropouts = {{0.4, 1, "link"}, {0.7, 4, "link"}};
    return recording;
}

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

}  // namespace
}  // namespace gyrolog
