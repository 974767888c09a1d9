#include "analysis/noise/clipping.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double no_limit = 1e9;

Column counts_between(double least, double most, double sd = 10.0, std::uint64_t seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.3, sd);
    std::vector<std::int16_t> counts(10'000);
    for (auto& x : counts) {
        x = static_cast<std::int16_t>(std::lround(std::clamp(normal(random), least, most)));
    }
    return {"gx", "lsb", counts, 1.0, 0.0, "lsb"};
}

TEST(Clipping, IsSeenAtEitherEnd) {
    EXPECT_TRUE(is_clipped(counts_between(-no_limit, 15.0)));
    EXPECT_TRUE(is_clipped(counts_between(-15.0, no_limit)));
}

TEST(Clipping, OfRealNumbersIsSeenAsWell) {
    Column column = counts_between(-no_limit, 15.0);
    column.data = column.values();
    EXPECT_TRUE(is_clipped(column));
}

TEST(Clipping, IsNotSeenWhereNoiseEndsByItself) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        for (const double sd : {0.2, 0.4, 1.0, 10.0, 3000.0}) {
            EXPECT_FALSE(is_clipped(counts_between(-no_limit, no_limit, sd, seed))) << sd << ' ' << seed;
        }
    }
}

TEST(Clipping, NeedsTwentySamplesAtTheWall) {
    std::vector<double> data = {5.0, 4.0, 3.0};
    data.resize(21, 5.0);
    const auto column = [&] { return Column{"gx", "rad/s", data, 1.0, 0.0, "rad_s"}; };
    EXPECT_FALSE(is_clipped(column()));
    data.push_back(5.0);
    EXPECT_TRUE(is_clipped(column()));
    EXPECT_FALSE(is_clipped(column(), 2.0)) << "of which each stands for its neighbour";
    data.insert(data.end(), 9, 4.0);
    EXPECT_FALSE(is_clipped(column())) << "ten beside twenty are no wall";
}

TEST(Clipping, IsNotSeenInOneOrTwoValues) {
    std::vector<std::int16_t> counts(1000, 7);
    const auto column = [&] { return Column{"gx", "lsb", counts, 1.0, 0.0, "lsb"}; };
    EXPECT_FALSE(is_clipped(column()));
    std::fill_n(counts.begin(), 30, std::int16_t{8});
    EXPECT_FALSE(is_clipped(column()));
    counts.clear();
    EXPECT_FALSE(is_clipped(column()));
}

}  // namespace
}  // namespace gyrolog
