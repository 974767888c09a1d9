#include "analysis/numerics/repetition.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t length = 6000;
constexpr double step_s = 0.5;

std::vector<float> noise(std::uint64_t seed) {
    std::vector<float> series(length);
    for (std::size_t i = 0; i < length; ++i) {
        series[i] = static_cast<float>(RandomStream(seed, 3).normal(i));
    }
    return series;
}

Repetition best_of_octaves(const std::vector<std::vector<float>>& series) {
    const std::vector<Repetition> found = repetitions(series, step_s);
    return *std::ranges::max_element(found, {}, &Repetition::evidence_nats);
}

TEST(Repetition, OfNoiseHasHardlyEverEvidence) {
    constexpr std::uint64_t seeds = 60;
    int above = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        above += best_of_octaves({noise(3 * seed), noise(3 * seed + 1), noise(3 * seed + 2)}).evidence_nats >
                         std::log(20.0)
                     ? 1
                     : 0;
    }
    // One of twenty in each of eight octaves at most would be 20 of 60, with a standard deviation of 3.7.
    EXPECT_LE(above, 20);
}

TEST(Repetition, IsFoundAtItsPeriodHoweverSharp) {
    for (const double duty : {0.02, 0.1, 0.5}) {
        constexpr double period_s = 87.3;
        std::vector<float> series = noise(5);
        // As much energy for every duty: 120 nats.
        const double height = std::sqrt(2.0 * 120.0 / (duty * (1.0 - duty) * static_cast<double>(length)));
        for (std::size_t i = 0; i < length; ++i) {
            const double phase = std::fmod(static_cast<double>(i) * step_s, period_s) / period_s;
            series[i] += static_cast<float>(height * ((phase < duty ? 1.0 : 0.0) - duty));
        }
        const Repetition alone = best_of_octaves({series});
        EXPECT_NEAR(alone.period_s, period_s, 0.3) << duty;
        EXPECT_GT(alone.evidence_nats, 25.0) << duty;
        EXPECT_LT(alone.evidence_nats, 125.0) << duty;
        // Series without it cost nothing.
        EXPECT_NEAR(best_of_octaves({noise(6), series, noise(7)}).evidence_nats, alone.evidence_nats, 5.0);
    }
}

TEST(Repetition, SharedByAllIsFoundWhereNoneAloneShowsIt) {
    std::vector<std::vector<float>> series = {noise(11), noise(12), noise(13)};
    for (std::vector<float>& one : series) {
        for (std::size_t i = 0; i < length; ++i) { one[i] += i % 150 < 12 ? 0.36F : 0.0F; }
    }
    const Repetition together = best_of_octaves(series);
    EXPECT_NEAR(together.period_s, 75.0, 0.3);
    for (const std::vector<float>& one : series) {
        EXPECT_GT(together.evidence_nats, best_of_octaves({one}).evidence_nats + 5.0);
    }
}

}  // namespace
}  // namespace gyrolog
