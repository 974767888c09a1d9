#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/null_judgement.hpp"

namespace gyrolog {
namespace {

// Looks of simulations and of a recording like them, which hang together by `shared`: 0 independent, 1 the
// same.
struct Looks {
    std::vector<double> effects_nats;
    std::vector<double> curves_nats;
};

Looks looks_of(std::size_t count, double shared, std::mt19937_64& engine) {
    std::exponential_distribution<double> chance;
    std::bernoulli_distribution is_same(shared);
    Looks looks;
    for (std::size_t i = 0; i < count; ++i) {
        looks.effects_nats.push_back(chance(engine));
        looks.curves_nats.push_back(is_same(engine) ? looks.effects_nats.back() : chance(engine));
    }
    return looks;
}

// Without a gap every probability is as likely as any other, also above a half.
TEST(ProbabilityByRank, IsRightOverItsWholeRange) {
    constexpr int recordings = 1500;
    constexpr std::size_t simulations = 100;
    std::mt19937_64 engine(20261125);
    for (const double shared : {0.0, 0.5, 1.0}) {
        std::vector<double> p;
        for (int i = 0; i < recordings; ++i) {
            Looks looks = looks_of(simulations + 1, shared, engine);
            const double effect_nats = looks.effects_nats.back();
            const double curve_nats = looks.curves_nats.back();
            looks.effects_nats.pop_back();
            looks.curves_nats.pop_back();
            p.push_back(probability_by_rank(effect_nats, looks.effects_nats, curve_nats, looks.curves_nats));
        }
        for (const double level : {0.05, 0.1, 0.25, 0.5, 0.75, 0.9}) {
            const auto below = std::ranges::count_if(p, [&](double one) { return one <= level; });
            const double sd = std::sqrt(level * (1.0 - level) / recordings);
            // Four standard deviations, and the ranks' steps.
            EXPECT_NEAR(static_cast<double>(below) / recordings, level, 4.0 * sd + 2.0 / simulations)
                << "p <= " << level << ", shared " << shared;
        }
    }
}

// One simulation that is unlike all others must not make a number of none.
TEST(ProbabilityByRank, IsANumberWhereASimulationStandsFarOut) {
    std::mt19937_64 engine(4);
    Looks looks = looks_of(20, 0.0, engine);
    looks.curves_nats[7] = 13000.0;
    const double p = probability_by_rank(1740.0, looks.effects_nats, 3900.0, looks.curves_nats);
    EXPECT_GE(p, 0.0);
    EXPECT_LE(p, 0.1);
}

// Beyond the simulations' number it falls as the looks' own tails do.
TEST(ProbabilityByRank, FallsOnBeyondTheSimulations) {
    std::mt19937_64 engine(3);
    const Looks looks = looks_of(200, 0.0, engine);
    const double p20 = probability_by_rank(20.0, looks.effects_nats, 0.1, looks.curves_nats);
    const double p30 = probability_by_rank(30.0, looks.effects_nats, 0.1, looks.curves_nats);
    EXPECT_LT(p20, 1e-6);
    EXPECT_NEAR(std::log(p20 / p30), 10.0, 4.0);
}

}  // namespace
}  // namespace gyrolog
