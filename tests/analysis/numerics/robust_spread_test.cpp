#include "analysis/numerics/robust_spread.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {
namespace {

std::vector<double> normals(std::uint32_t stream, std::size_t count) {
    std::vector<double> values(count);
    RandomStream(11, stream).normals(0, values);
    return values;
}

TEST(RobustSpread, MedianOfAnOddAndAnEvenNumberOfValues) {
    EXPECT_EQ(median_of(std::vector{3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median_of(std::vector{4.0, 1.0, 2.0, 3.0}), 2.5);
    EXPECT_EQ(median_of(std::vector{7.0}), 7.0);
}

// B. Iglewicz and D. C. Hoaglin's factor 0.6745 is 1 / 1.4826; of five values b_5 is 1.206.
TEST(RobustSpread, IsTheMedianAbsoluteDeviationWithItsTwoFactors) {
    const std::vector values{1.0, 2.0, 3.0, 5.0, 900.0};
    const RobustSpread spread = robust_spread(values, std::vector<double>(5, 0.0));
    EXPECT_EQ(spread.count, 5U);
    EXPECT_EQ(spread.median, 3.0);
    EXPECT_NEAR(spread.observed_sd, 2.0 * 1.206 / 0.67449, 1e-4);
    EXPECT_EQ(spread.sd, spread.observed_sd);
}

TEST(RobustSpread, ShiftsAndScalesWithTheValues) {
    const std::vector<double> values = normals(1, 31);
    std::vector<double> others;
    for (const double value : values) { others.push_back(7.0 - 3.0 * value); }
    const RobustSpread one = robust_spread(values, std::vector<double>(31, 0.1));
    const RobustSpread other = robust_spread(others, std::vector<double>(31, 0.3));
    EXPECT_NEAR(other.median, 7.0 - 3.0 * one.median, 1e-12);
    EXPECT_NEAR(other.sd, 3.0 * one.sd, 1e-12);
    EXPECT_NEAR(other.sd_lo, 3.0 * one.sd_lo, 1e-12);
    EXPECT_NEAR(other.sd_hi, 3.0 * one.sd_hi, 1e-12);
}

TEST(RobustSpread, TakesOutWhatTheValuesOwnUncertaintyAdds) {
    constexpr std::size_t count = 4000;
    const std::vector<double> units = normals(2, count);
    const std::vector<double> errors = normals(3, count);
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) { values.push_back(2.0 * units[i] + 1.5 * errors[i]); }
    const RobustSpread spread = robust_spread(values, std::vector<double>(count, 1.5));
    EXPECT_NEAR(spread.observed_sd, 2.5, 0.15);
    EXPECT_NEAR(spread.sd, 2.0, 0.19) << "four standard deviations: 4 * 2.5^2 / 2 * sqrt(1.36 / 4000)";
    const RobustSpread none = robust_spread(errors, std::vector<double>(count, 1.5));
    EXPECT_EQ(none.sd, 0.0) << "less than their own uncertainty explains";
}

TEST(RobustSpread, AFifthOfOddOnesMovesItLittle) {
    std::vector<double> values = normals(4, 200);
    for (std::size_t i = 0; i < 40; ++i) { values[i] += 1e6; }
    const RobustSpread spread = robust_spread(values, std::vector<double>(200, 0.0));
    EXPECT_LT(spread.observed_sd, 1.7);
    EXPECT_LT(std::abs(spread.median), 0.6);
}

TEST(RobustSpread, ItsIntervalHoldsTheTruthAsOftenAsItSays) {
    for (const std::size_t count : {4U, 5U, 8U, 20U, 200U}) {
        int held = 0;
        double sum = 0.0;
        constexpr int repetitions = 2000;
        for (std::uint32_t i = 0; i < repetitions; ++i) {
            const RobustSpread spread =
                robust_spread(normals(1000 * static_cast<std::uint32_t>(count) + 100'000 + i, count),
                              std::vector<double>(count, 0.0));
            held += spread.sd_lo < 1.0 && spread.sd_hi > 1.0 ? 1 : 0;
            sum += spread.sd;
        }
        // Three standard deviations of a share of 2000 are 1.5 %; what the header states beside them.
        EXPECT_NEAR(static_cast<double>(held) / repetitions, 0.95, 0.015 + 0.02) << count << " values";
        EXPECT_NEAR(sum / repetitions, 1.0, 0.05) << count << " values";
    }
}

}  // namespace
}  // namespace gyrolog
