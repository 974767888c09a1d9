#include "analysis/recording/block_means.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void expect_block(const BlockMean& block, std::int64_t index, std::size_t samples, double mean) {
    EXPECT_EQ(block.index, index);
    EXPECT_EQ(block.samples, samples);
    EXPECT_DOUBLE_EQ(block.mean, mean);
}

TEST(BlockMeans, AreOfTheInstantsOfEachBlockAlsoAcrossSegments) {
    const Column column{"gx", "rad/s", std::vector<double>{1, 2, 3, 4, 5, 6}, 1.0, 0.0, ""};
    // Instants 10 11 12 | 13 . 15 | . . . | . 20 21, counted in threes from the first.
    const std::vector<Segment> segments = {{0, 4, 10}, {4, 1, 15}, {5, 1, 20}};
    const auto blocks = block_means(column, segments, 3);
    ASSERT_EQ(blocks.size(), 3U);
    expect_block(blocks[0], 0, 3, 2.0);
    expect_block(blocks[1], 1, 2, 4.5);
    expect_block(blocks[2], 3, 1, 6.0);
}

TEST(BlockMeans, LeaveOutWhatIsNotKnown) {
    const Column column{"temp", "degC", std::vector<double>{unknown, 2, unknown, unknown, 5, 7},
                        1.0,    0.0,    ""};
    const auto blocks = block_means(column, std::vector<Segment>{{0, 6, 0}}, 2);
    ASSERT_EQ(blocks.size(), 2U);
    expect_block(blocks[0], 0, 1, 2.0);
    expect_block(blocks[1], 2, 2, 6.0);
}

TEST(BlockMeans, OfCountsHaveTheirScaleAndOffset) {
    const Column column{"temp", "degC", std::vector<std::int16_t>{100, 300, 500}, 0.01, 21.0, ""};
    const auto blocks = block_means(column, std::vector<Segment>{{0, 3, 7}}, 2);
    ASSERT_EQ(blocks.size(), 2U);
    expect_block(blocks[0], 0, 2, 23.0);
    expect_block(blocks[1], 1, 1, 26.0);
    EXPECT_TRUE(block_means(column, {}, 2).empty());
}

}  // namespace
}  // namespace gyrolog
