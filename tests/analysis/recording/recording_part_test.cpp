#include "analysis/recording/recording_part.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/recording/recording_with_holes.hpp"

namespace gyrolog {
namespace {

TEST(SegmentsWithin, AreCutAtTheEnds) {
    const std::vector<Segment> parts{{0, 100, 7}, {100, 100, 207}};
    const std::vector<Segment> cut = segments_within(parts, 100.0, {0.5, 2.2});
    ASSERT_EQ(cut.size(), 2U);
    EXPECT_EQ(cut[0].first, 50U);
    EXPECT_EQ(cut[0].count, 50U);
    EXPECT_EQ(cut[0].first_index, 57);
    EXPECT_EQ(cut[1].first, 100U);
    EXPECT_EQ(cut[1].count, 20U);
}

// Whatever is left out: the samples, the holes between them and the times are those of the whole.
TEST(PartOf, IsARecordingOfItsOwn) {
    const Recording whole = with_holes();
    for (int from = 0; from < 15; ++from) {
        for (int to = from + 1; to <= 15; ++to) {
            SCOPED_TRACE(testing::Message() << from << " to " << to);
            const Recording part = part_of(whole, {0.1 * from, 0.1 * to});
            std::vector<double> wanted_s;
            for (const double t_s : whole.t_s) {
                if (t_s > 0.1 * from - 0.01 && t_s < 0.1 * to - 0.01) { wanted_s.push_back(t_s); }
            }
            ASSERT_EQ(part.t_s, wanted_s);
            ASSERT_EQ(part.rows(), wanted_s.size());
            if (wanted_s.empty()) {
                EXPECT_TRUE(part.dropouts.empty());
                continue;
            }
            EXPECT_NEAR(part.duration_s(), wanted_s.back() - wanted_s.front() + 0.1, 1e-12);
            EXPECT_EQ(part.segments.front().first_index, 0);
            std::int64_t missing = 0;
            for (const Dropout& dropout : part.dropouts) {
                missing += dropout.samples;
                EXPECT_NEAR(dropout.at_s + wanted_s.front(), dropout.samples == 1 ? 0.4 : 0.7, 1e-12);
            }
            EXPECT_EQ(missing, part.missing_samples());
        }
    }
}

}  // namespace
}  // namespace gyrolog
