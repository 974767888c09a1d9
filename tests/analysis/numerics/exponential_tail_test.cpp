#include "analysis/numerics/exponential_tail.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

std::vector<double> drawn(std::uint64_t seed, std::size_t count) {
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> distribution(2.0);
    std::vector<double> values(count);
    std::ranges::generate(values, [&] { return distribution(random); });
    return values;
}

int samples_with_one_beyond(double chance, int samples) {
    int beyond = 0;
    for (int i = 0; i < samples; ++i) {
        const std::vector<double> values = drawn(static_cast<std::uint64_t>(i) + 1, 2000);
        const auto tail = ExponentialTail::of(values, {});
        beyond += std::ranges::max(values) > tail->end(values, chance) ? 1 : 0;
    }
    return beyond;
}

// The upper quarter of the tail takes no part in its mean, but the largest number depends on the rest.
TEST(ExponentialTail, IsExceededAsOftenAsSaid) {
    constexpr int samples = 2000;
    constexpr double chance = 0.05;
    const int beyond = samples_with_one_beyond(chance, samples);
    std::cout << "of " << samples << " samples " << beyond << " have a number beyond the end\n";
    const double expected = chance * samples;
    EXPECT_NEAR(beyond, expected, 4.5 * std::sqrt(expected * (1.0 - chance)));
}

TEST(ExponentialTail, EndsBeforeWhatIsNoPartOfIt) {
    std::vector<double> values = drawn(1, 2000);
    const double alone = ExponentialTail::of(values, {})->end(values, 0.01);
    for (int i = 0; i < 5; ++i) { values.push_back(30.0 + i); }
    const auto tail = ExponentialTail::of(values, {});
    const double end = tail->end(values, 0.01);
    EXPECT_EQ(std::ranges::count_if(values, [&](double value) { return value > end; }), 5);
    // Five that are beyond allow the next to be nearer.
    EXPECT_LT(end, alone);
    EXPECT_GT(end, 0.5 * alone);
}

TEST(ExponentialTail, TellsHowSurprisingANumberIs) {
    const std::vector<double> values = drawn(2, 20'000);
    const auto tail = ExponentialTail::of(values, {});
    const std::vector<double> nats = tail->surprisals_nats(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double exact_nats = 2.0 * values[i];
        // Of the share that is as large, which is a Poisson count; beyond the threshold of the mean as well.
        const double as_large = 20'000.0 * std::exp(-exact_nats);
        const double sd = 1.0 / std::sqrt(std::max(as_large, 500.0)) + std::max(0.0, exact_nats - 3.0) / 27.0;
        EXPECT_NEAR(nats[i], exact_nats, 4.5 * sd) << i;
    }
}

TEST(ExponentialTail, NeedsSomeNumbers) {
    EXPECT_FALSE(ExponentialTail::of(drawn(3, 39), {}));
    EXPECT_TRUE(ExponentialTail::of(drawn(3, 40), {}));
}

TEST(ExponentialTail, HasTheLeastMean) {
    std::vector<double> equal(100, 1.0);
    const auto tail = ExponentialTail::of(equal, {.mean_least = 0.5});
    equal.push_back(1.5);
    EXPECT_GT(tail->end(equal, 0.01), 1.0 + 0.5 * std::log(20 / 0.01));
}

}  // namespace
}  // namespace gyrolog
