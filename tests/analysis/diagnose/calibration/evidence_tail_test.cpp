#include "analysis/diagnose/calibration/evidence_tail.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {
namespace {

std::vector<double> exponential_draws(std::size_t count, std::uint32_t stream) {
    const RandomStream random(5, stream);
    std::vector<double> draws;
    for (std::size_t i = 0; i < count; ++i) { draws.push_back(-std::log(random.uniform(i))); }
    return draws;
}

TEST(EvidenceTail, GivesEveryProbabilityAsOftenAsItSays) {
    constexpr int repeats = 4000;
    int below_tenth = 0;
    int below_hundredth = 0;
    for (int i = 0; i < repeats; ++i) {
        std::vector<double> draws = exponential_draws(201, static_cast<std::uint32_t>(i));
        const double own = draws.back();
        draws.pop_back();
        const double p = EvidenceTail(std::move(draws)).probability(own);
        below_tenth += p <= 0.1;
        below_hundredth += p <= 0.01;
    }
    EXPECT_NEAR(below_tenth, 400, 4.0 * std::sqrt(360.0));
    // The tail's own scale, from twenty draws, is uncertain.
    EXPECT_NEAR(below_hundredth, 40, 4.0 * std::sqrt(40.0));
}

TEST(EvidenceTail, FallsNoFasterThanALikelihoodRatioDoes) {
    std::vector<double> narrow(200);
    for (std::size_t i = 0; i < narrow.size(); ++i) { narrow[i] = 1e-3 * static_cast<double>(i); }
    const EvidenceTail tail(std::move(narrow));
    EXPECT_NEAR(tail.probability(10.2), tail.probability(0.2) * std::exp(-10.0), 1e-9);
}

TEST(EvidenceTail, OfWhatIsRarerThanTheSmallestNumberHasAFiniteSurprise) {
    const EvidenceTail tail(exponential_draws(200, 4));
    const double per_nat = tail.surprise_nats(20.0) - tail.surprise_nats(19.0);
    EXPECT_NEAR(tail.surprise_nats(1e5), tail.surprise_nats(20.0) + per_nat * (1e5 - 20.0), 1e-3);
    EXPECT_EQ(tail.probability(1e5), 0.0);
}

TEST(EvidenceTail, HasTheThresholdOfEveryProbability) {
    const EvidenceTail tail(exponential_draws(200, 9));
    for (const double p : {0.05, 0.01, 1e-4}) {
        EXPECT_NEAR(tail.probability(tail.threshold_nats(p)), p, 1e-9) << p;
    }
}

}  // namespace
}  // namespace gyrolog
