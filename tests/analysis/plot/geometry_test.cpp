#include "analysis/plot/geometry.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Box unit{0.0, 0.0, 1.0, 1.0};

double length_of(const Polyline& line) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        length += std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
    }
    return length;
}

double area_of(const Polyline& polygon) {
    double doubled = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point a = polygon[i];
        const Point b = polygon[(i + 1) % polygon.size()];
        doubled += a.x * b.y - b.x * a.y;
    }
    return std::fabs(doubled) / 2.0;
}

Point random_point(std::mt19937_64& random) {
    std::uniform_real_distribution<double> coordinate(-2.0, 3.0);
    const double x = coordinate(random);
    return {x, coordinate(random)};
}

// The share of many points along the segment that lie in the box is the share of the length that clipping
// keeps.
TEST(Clip, KeepsOfASegmentExactlyWhatIsInTheBox) {
    std::mt19937_64 random(1);
    constexpr int steps = 2000;
    for (int i = 0; i < 300; ++i) {
        const LineSegment segment{random_point(random), random_point(random)};
        int inside = 0;
        for (int k = 0; k < steps; ++k) {
            const double t = (k + 0.5) / steps;
            inside += unit.contains(Point{segment.a.x + t * (segment.b.x - segment.a.x),
                                          segment.a.y + t * (segment.b.y - segment.a.y)});
        }
        const auto kept = clip(segment, unit);
        const double share = kept ? length_of({kept->a, kept->b}) / length_of({segment.a, segment.b}) : 0.0;
        ASSERT_NEAR(share, static_cast<double>(inside) / steps, 2.0 / steps);
    }
}

TEST(Clip, LosesNoLengthOfALineThatStaysInside) {
    const Polyline line{{0.1, 0.1}, {0.9, 0.2}, {0.5, 0.7}, {0.5, 0.7}, {0.0, 1.0}};
    const auto parts = clip(line, unit);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_DOUBLE_EQ(length_of(parts[0]), length_of(line));
}

TEST(Clip, CutsALineThatLeavesAndReturnsIntoItsParts) {
    const auto parts = clip(Polyline{{0.5, 0.5}, {1.5, 0.5}, {1.5, 0.8}, {0.5, 0.8}}, unit);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_DOUBLE_EQ(parts[0].back().x, 1.0);
    EXPECT_DOUBLE_EQ(parts[1].front().x, 1.0);
    EXPECT_DOUBLE_EQ(parts[1].front().y, 0.8);
}

TEST(Clip, BreaksALineAtAPointThatIsNoNumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto parts =
        clip(Polyline{{0.1, 0.1}, {0.2, 0.1}, {0.3, nan}, {0.4, 0.1}, {0.5, 0.1}, {0.6, infinity}}, unit);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_DOUBLE_EQ(parts[0].back().x, 0.2);
    EXPECT_DOUBLE_EQ(parts[1].front().x, 0.4);
}

TEST(Clip, BearsTheLargestNumbers) {
    const double large = std::numeric_limits<double>::max();
    EXPECT_FALSE(clip(LineSegment{{-large, 0.5}, {large, 0.5}}, unit).has_value());
    const auto kept = clip(LineSegment{{-1e300, 0.5}, {1e300, 0.5}}, unit);
    ASSERT_TRUE(kept.has_value());
    EXPECT_TRUE(unit.grown(1e-9).contains(kept->a));
    EXPECT_TRUE(unit.grown(1e-9).contains(kept->b));
}

// Clipping to the four quarters of a box shares its area out.
TEST(ClipPolygon, SharesTheAreaOutBetweenNeighbours) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 300; ++i) {
        const Polyline triangle{random_point(random), random_point(random), random_point(random)};
        double sum = 0.0;
        for (const Box& part :
             {Box{-2, -2, 1, 0.5}, Box{1, -2, 3, 0.5}, Box{-2, 0.5, 1, 3}, Box{1, 0.5, 3, 3}}) {
            sum += area_of(clip_polygon(triangle, part));
        }
        ASSERT_NEAR(sum, area_of(triangle), 1e-9);
    }
}

TEST(ClipPolygon, LeavesNothingOfAPolygonOutside) {
    EXPECT_TRUE(clip_polygon({{2, 2}, {3, 2}, {3, 3}}, unit).empty());
}

TEST(Dashes, CoverTheirShareOfTheLine) {
    const Polyline line{{0, 0}, {300, 0}, {300, 400}, {0, 0}};
    const auto pieces = dashed(line, {7.0, 3.0});
    double drawn = 0.0;
    for (const Polyline& piece : pieces) { drawn += length_of(piece); }
    EXPECT_NEAR(drawn, 0.7 * length_of(line), 1e-9);
    EXPECT_EQ(pieces.size(), 120U);
}

TEST(Dashes, NoPatternMeansOneSolidPiece) {
    const Polyline line{{0, 0}, {10, 0}};
    ASSERT_EQ(dashed(line, {}).size(), 1U);
    ASSERT_EQ(dashed(line, {0.0, 0.0}).size(), 1U);
}

}  // namespace
}  // namespace gyrolog
