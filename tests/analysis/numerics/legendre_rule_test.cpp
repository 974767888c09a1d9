#include "analysis/numerics/legendre_rule.hpp"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// Abramowitz and Stegun, Handbook of Mathematical Functions, table 25.4, n = 7.
TEST(LegendreRule, HasThePublishedNodes) {
    const auto& rule = legendre_rule_of_seven();
    constexpr double x[] = {0.000000000000000, 0.405845151377397, 0.741531185599394, 0.949107912342759};
    constexpr double weight[] = {0.417959183673469, 0.381830050505119, 0.279705391489277, 0.129484966168870};
    for (std::size_t i = 0; i < rule.size(); ++i) {
        EXPECT_NEAR(rule[i].x, x[i], 0.6e-15) << i;
        EXPECT_NEAR(rule[i].weight, weight[i], 0.6e-15) << i;
    }
    EXPECT_EQ(rule.front().x, 0.0);
}

TEST(LegendreRule, IsExactToTheThirteenthDegree) {
    for (int power = 0; power <= 12; power += 2) {
        double sum = 0.0;
        for (const auto& [x, weight] : legendre_rule_of_seven()) {
            sum += (x > 0.0 ? 2.0 : 1.0) * weight * std::pow(x, power);
        }
        EXPECT_NEAR(sum, 2.0 / (power + 1), 1e-15) << power;
    }
}

}  // namespace
}  // namespace gyrolog
