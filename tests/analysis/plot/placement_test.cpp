#include "analysis/plot/placement.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr Box room{100.0, 50.0, 1100.0, 750.0};

Polyline random_walk(std::mt19937_64& random, int points) {
    std::normal_distribution<double> step(0.0, 900.0 / std::sqrt(points));
    Polyline line;
    double y = std::uniform_real_distribution<double>(room.top, room.bottom)(random);
    for (int i = 0; i < points; ++i) {
        y = std::min(std::max(y + step(random), room.top), room.bottom);
        line.push_back({room.left + room.width() * i / (points - 1), y});
    }
    return line;
}

TEST(PlaceInCorner, CoversNoPointOfAnyCurve) {
    std::mt19937_64 random(1);
    int placed = 0;
    for (int round = 0; round < 400; ++round) {
        const Polyline line = random_walk(random, 5 + round % 200);
        Obstacles obstacles;
        obstacles.add(line);
        const auto box = place_in_corner({300.0, 160.0}, room, 10.0, obstacles);
        if (!box) { continue; }
        ++placed;
        ASSERT_TRUE(room.contains(*box));
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            for (int k = 0; k <= 50; ++k) {  // along the segment, not only at its ends
                const double t = k / 50.0;
                const Point p{line[i].x + t * (line[i + 1].x - line[i].x),
                              line[i].y + t * (line[i + 1].y - line[i].y)};
                ASSERT_FALSE(box->contains(p));
            }
        }
    }
    EXPECT_GT(placed, 300);
}

TEST(PlaceInCorner, PrefersTheTopRightCornerThenTheOthers) {
    Obstacles obstacles;
    const auto corner = [&] { return place_in_corner({100.0, 50.0}, room, 10.0, obstacles); };
    EXPECT_EQ(corner()->right, 1090.0);
    EXPECT_EQ(corner()->top, 60.0);
    obstacles.add(Box{800.0, 50.0, 1100.0, 300.0});
    EXPECT_EQ(corner()->right, 1090.0);
    EXPECT_EQ(corner()->bottom, 740.0);
    obstacles.add(Box{800.0, 500.0, 1100.0, 750.0});
    EXPECT_EQ(corner()->left, 110.0);
    EXPECT_EQ(corner()->top, 60.0);
}

TEST(PlaceInCorner, FindsTheOnlyHoleInACrowd) {
    Obstacles obstacles;
    for (double x = room.left; x <= room.right; x += 20.0) {
        for (double y = room.top; y <= room.bottom; y += 20.0) {
            if (!Box{480.0, 280.0, 760.0, 480.0}.contains(Point{x, y})) { obstacles.add(Polyline{{x, y}}); }
        }
    }
    const auto box = place_in_corner({180.0, 110.0}, room, 5.0, obstacles);
    ASSERT_TRUE(box.has_value());
    EXPECT_TRUE((Box{460.0, 260.0, 780.0, 500.0}.contains(*box)));
    EXPECT_FALSE(place_in_corner({400.0, 110.0}, room, 5.0, obstacles).has_value());
}

TEST(PlaceInCorner, StaysOutOfAFilledAreaWhoseOutlineItDoesNotTouch) {
    Obstacles obstacles;
    obstacles.add_area({{0.0, 0.0}, {1200.0, 0.0}, {1200.0, 800.0}, {0.0, 800.0}});
    EXPECT_FALSE(place_in_corner({50.0, 20.0}, room, 0.0, obstacles).has_value());
}

TEST(PlaceInCorner, RefusesABoxLargerThanTheRoom) {
    EXPECT_FALSE(place_in_corner({1001.0, 20.0}, room, 0.0, {}).has_value());
    EXPECT_TRUE(place_in_corner({1000.0, 700.0}, room, 0.0, {}).has_value());
}

TEST(PlaceBeside, StaysNearItsPointAndClearOfEverything) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 300; ++round) {
        Obstacles obstacles;
        obstacles.add(random_walk(random, 60));
        const Point anchor{std::uniform_real_distribution<double>(room.left, room.right)(random),
                           std::uniform_real_distribution<double>(room.top, room.bottom)(random)};
        const auto box = place_beside(anchor, 12.0, {30.0, 20.0}, room, obstacles);
        if (!box) { continue; }
        EXPECT_TRUE(room.contains(*box));
        EXPECT_FALSE(obstacles.touches(*box));
        EXPECT_FALSE(box->contains(anchor));
        EXPECT_LE(std::hypot(box->centre().x - anchor.x, box->centre().y - anchor.y),
                  36.0 + std::hypot(15.0, 10.0));
    }
}

}  // namespace
}  // namespace gyrolog
