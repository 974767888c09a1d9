// What an analysis of sensor counts takes of memory, by counting what is allocated.

#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/allan/running_allan.hpp"
#include "tests/support/heap_account.hpp"

namespace gyrolog {
namespace {

TEST(AllanMemory, OfThreeAxesOfCountsStaysBelowTheSamplesAsDoubles) {
    constexpr std::size_t samples = 1'000'000;
    const std::size_t before = bytes_now;
    std::mt19937_64 random(1);
    std::vector<Column> axes;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::int16_t> counts(samples);
        for (auto& x : counts) { x = static_cast<std::int16_t>(random() % 64U); }
        axes.push_back({"gx", "rad/s", std::move(counts), 1.0, 0.0, "lsb"});
    }
    const std::vector<Segment> whole = {{0, samples, 0}};
    bytes_most = bytes_now.load();
    for (const Column& axis : axes) { EXPECT_GT(allan_deviation(axis, whole, 100.0).points.size(), 80U); }
    const std::size_t used = bytes_most - before;
    EXPECT_LT(used, 3 * samples * sizeof(double)) << used << " bytes";
    // Two bytes of counts for each axis, four of theta for one, and what does not grow with the record.
    EXPECT_LT(used, (3 * 2 + 4) * samples + 4'000'000) << used << " bytes";
}

TEST(AllanMemory, OfASignalThatIsStillComingInDoesNotGrow) {
    const std::size_t before = bytes_now;
    RunningAllan running;
    const std::size_t empty = bytes_now - before;
    EXPECT_LT(empty, 16'000U);
    bytes_most = bytes_now.load();
    std::minstd_rand random(1);
    for (std::int64_t i = 0; i < 2'000'000; ++i) {
        running.take(i, static_cast<std::int16_t>(random() % 64U));
    }
    EXPECT_EQ(bytes_most - before, empty);
    EXPECT_EQ(running.points(1.0).back().m, std::int64_t{1} << 19);
}

}  // namespace
}  // namespace gyrolog
