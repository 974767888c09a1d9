#include "analysis/numerics/log_sum_exp.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(LogSumExp, IsTheLogarithmOfTheSum) {
    EXPECT_NEAR(log_sum_exp(std::vector<double>{std::log(1.0), std::log(2.0), std::log(5.0)}), std::log(8.0),
                1e-15);
    EXPECT_EQ(log_sum_exp(std::vector<double>{-3.5}), -3.5);
}

TEST(LogSumExp, NeitherOverflowsNorVanishes) {
    EXPECT_NEAR(log_sum_exp(std::vector<double>{1e4, 1e4}), 1e4 + std::log(2.0), 1e-11);
    EXPECT_NEAR(log_sum_exp(std::vector<double>{-1e4, -1e4, -2e4}), -1e4 + std::log(2.0), 1e-11);
}

TEST(LogSumExp, CountsMinusInfinityForNothing) {
    const double nothing = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(log_sum_exp(std::vector<double>{nothing, 2.0}), 2.0);
}

}  // namespace
}  // namespace gyrolog
