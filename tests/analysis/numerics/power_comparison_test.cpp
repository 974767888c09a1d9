#include "analysis/numerics/power_comparison.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(PowerComparison, TellsPowersOfTwoFromTheirNeighbours) {
    constexpr std::uint64_t two_to_40 = std::uint64_t{1} << 40U;
    EXPECT_TRUE(power_reaches(two_to_40, 99, 3960));
    EXPECT_FALSE(power_reaches(two_to_40, 99, 3961));
    EXPECT_FALSE(power_reaches(two_to_40 - 1, 99, 3960));
    EXPECT_TRUE(power_reaches(two_to_40 - 1, 99, 3959));
    EXPECT_FALSE(power_reaches(~std::uint64_t{0}, 99, 64 * 99));
    EXPECT_TRUE(power_reaches(~std::uint64_t{0}, 99, 64 * 99 - 1));
}

TEST(PowerComparison, AgreesWithLogarithmsWhereTheyCanTell) {
    for (std::uint64_t base = 2; base < 2000; base += 7) {
        if ((base & (base - 1)) == 0) { continue; }
        const auto bits = static_cast<unsigned>(std::floor(99.0 * std::log2(static_cast<double>(base))));
        EXPECT_TRUE(power_reaches(base, 99, bits)) << base;
        EXPECT_FALSE(power_reaches(base, 99, bits + 1)) << base;
    }
}

TEST(PowerComparison, OfNoughtAndOne) {
    EXPECT_TRUE(power_reaches(1, 99, 0));
    EXPECT_FALSE(power_reaches(1, 99, 1));
    EXPECT_TRUE(power_reaches(0, 0, 0));
    EXPECT_FALSE(power_reaches(0, 1, 0));
    EXPECT_FALSE(power_reaches(5, 0, 1));
}

}  // namespace
}  // namespace gyrolog
