#include "analysis/noise/walk_knowledge.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/running_allan.hpp"
#include "analysis/noise/likelihood_fit.hpp"
#include "tests/analysis/noise/over_seeds.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 5.0;
constexpr double wanted = 0.2;
constexpr NoiseCoefficients white_and_walk{0.0, 0.01, 0.0, 4e-4, 0.0};

// Counts of 0.01: the converter's error is a twentieth of the white noise.
std::vector<std::int16_t> record(double length_s, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<std::int16_t> counts(static_cast<std::size_t>(length_s * rate_hz));
    double walk = 0.0;
    for (std::int16_t& count : counts) {
        walk += white_and_walk.K_rad_per_s_sqrt_s / std::sqrt(rate_hz) * normal(random);
        const double rate = walk + white_and_walk.N_rad_per_sqrt_s * std::sqrt(rate_hz) * normal(random);
        count = static_cast<std::int16_t>(std::lround(rate / 0.01));
    }
    return counts;
}

// Published: sd of K 21.1 % in 6 h at 10 Hz, by the exact likelihood
// (tests/analysis/noise/noise_accuracy_test).
TEST(WalkKnowledge, IsTheBoundThatWasWorkedOutElsewhere) {
    const NoiseCoefficients noise{0.0, 0.01, 0.002, 1e-4, 0.0};
    EXPECT_NEAR(walk_relative_sd(noise, 10.0, 21'600.0).value(), 0.211, 0.012);
    EXPECT_NEAR(length_to_know_walk_s(noise, 10.0, 0.211).value(), 21'600.0, 0.12 * 21'600.0);
}

// White noise that is known and a walk, B far below: the integral has the closed form sqrt(2 N / (K T)). Not
// knowing N costs nothing where the band is wide, not knowing B a factor that depends on nothing else.
TEST(WalkKnowledge, GrowsWithTheSquareRootOfTheLength) {
    const auto sd = [](double length_s) {
        return walk_relative_sd(white_and_walk, rate_hz, length_s).value();
    };
    const double closed = std::sqrt(2.0 * 0.01 / (4e-4 * 1e6));
    EXPECT_GT(sd(1e6), closed);
    EXPECT_LT(sd(1e6), 3.0 * closed);
    EXPECT_NEAR(sd(1e6) / sd(4e6), 2.0, 0.01);
    const auto length_s = length_to_know_walk_s(white_and_walk, rate_hz, 0.05).value();
    EXPECT_NEAR(sd(length_s), 0.05, 1e-4);
}

// Flicker that is all there is: n samples tell its square to sqrt(2 / n) at best. That the white noise and
// the walk are not known costs a factor.
TEST(WalkKnowledge, OfFlickerGrowsWithTheSquareRootOfTheLength) {
    const NoiseCoefficients flicker{0.0, 1e-3, 0.01, 0.0, 0.0};
    const auto sd = [&](double length_s) { return flicker_relative_sd(flicker, rate_hz, length_s).value(); };
    const double at_best = 1.0 / std::sqrt(2.0 * rate_hz * 1e5);
    EXPECT_GT(sd(1e5), at_best);
    EXPECT_LT(sd(1e5), 4.0 * at_best);
    const auto length_s = length_to_know_flicker_s(flicker, rate_hz, 0.05).value();
    EXPECT_NEAR(sd(length_s), 0.05, 1e-4);
    // A unit a million times as large.
    const NoiseCoefficients tiny{0.0, 1e-9, 1e-8, 0.0, 0.0};
    EXPECT_NEAR(flicker_relative_sd(tiny, rate_hz, 1e5).value() / sd(1e5), 1.0, 1e-6);
    EXPECT_FALSE(flicker_relative_sd(white_and_walk, rate_hz, 1e5).has_value());
}

TEST(WalkKnowledge, DependsOnNoUnit) {
    const NoiseCoefficients tiny{0.0, 0.01e-4, 0.002e-4, 1e-8, 0.0};
    const NoiseCoefficients usual{0.0, 0.01, 0.002, 1e-4, 0.0};
    EXPECT_NEAR(walk_relative_sd(tiny, 10.0, 1e5).value(), walk_relative_sd(usual, 10.0, 1e5).value(), 1e-9);
}

TEST(WalkKnowledge, ThereIsNoneOfAWalkThatIsNotThere) {
    EXPECT_FALSE(walk_relative_sd({0.0, 0.01, 0.0, 0.0, 0.0}, 10.0, 1e5).has_value());
    EXPECT_FALSE(length_to_know_walk_s({0.0, 0.01, 0.0, 0.0, 0.0}, 10.0, wanted).has_value());
    EXPECT_FALSE(walk_relative_sd(white_and_walk, 10.0, 0.5).has_value());
}

// Simulated: at the length that is said, the likelihood fit has K to so much.
TEST(WalkKnowledge, RecordOfTheLengthThatIsSaidTellsKSoWell) {
    const double length_s = length_to_know_walk_s(white_and_walk, rate_hz, wanted).value();
    const auto errors = test::over_seeds(40, [&](std::uint64_t seed) {
        Column column;
        column.data = record(length_s, seed);
        column.scale = 0.01;
        const std::vector<Segment> whole{{0, column.size(), 0}};
        const NoiseFit start = fit_noise(allan_deviation(column, whole, rate_hz));
        const auto fit = fit_likelihood(column, whole, rate_hz, start);
        return fit->best.coefficients.K_rad_per_s_sqrt_s / white_and_walk.K_rad_per_s_sqrt_s - 1.0;
    });
    double square = 0.0;
    for (const double error : errors) { square += error * error / static_cast<double>(errors.size()); }
    std::printf("%.2f h at %g Hz: K to %.1f %% over %zu records, said %.0f %%\n", length_s / 3600.0, rate_hz,
                100.0 * std::sqrt(square), errors.size(), 100.0 * wanted);
    // One standard deviation of a root mean square of 40 is 11 %; the fit itself is within 15 % of the bound.
    EXPECT_NEAR(std::sqrt(square), wanted, 0.35 * wanted);
}

NoiseCoefficients live_estimate(double length_s, std::uint64_t seed) {
    RunningAllan running;
    std::int64_t index = 0;
    for (const std::int16_t count : record(length_s, seed)) { running.take(index++, count); }
    return coefficients_of(running.describe(rate_hz, 0.01).laws, rate_hz);
}

// Simulated: what is said a third of the way, from the running curve alone, comes near to it; and hardly a
// walk goes unseen that would be known as well as that.
TEST(WalkKnowledge, IsForetoldFromTheRunningCurveOfAShorterRecord) {
    constexpr std::size_t records = 200;
    const double length_s = length_to_know_walk_s(white_and_walk, rate_hz, wanted).value();
    auto foretold = test::over_seeds(records, [&](std::uint64_t seed) {
        const NoiseCoefficients noise = live_estimate(length_s / 3.0, seed);
        return length_to_know_walk_s(noise, rate_hz, wanted).value_or(1e12) / length_s;
    });
    std::ranges::sort(foretold);
    const auto seen = std::ranges::count_if(foretold, [](double length) { return length < 1e6; });
    std::printf("foretold over needed length: seen in %ld of %zu, quartiles %.2f %.2f %.2f\n",
                static_cast<long>(seen), records, foretold[records / 4], foretold[records / 2],
                foretold[3 * records / 4]);
    EXPECT_GT(seen, 130);
    EXPECT_GT(foretold[records / 20], 0.5);
    EXPECT_NEAR(foretold[records / 2], 1.1, 0.2);
    EXPECT_LT(foretold[3 * records / 4], 2.5);
}

TEST(WalkKnowledge, HardlyAWalkGoesUnseenThatIsSaidToShow) {
    constexpr std::size_t records = 200;
    const double length_s = length_to_know_walk_s(white_and_walk, rate_hz, 0.22).value();
    EXPECT_NEAR(walk_seen_from(white_and_walk, rate_hz, length_s).value(), white_and_walk.K_rad_per_s_sqrt_s,
                0.01 * white_and_walk.K_rad_per_s_sqrt_s);
    const auto K = test::over_seeds(
        records, [&](std::uint64_t seed) { return live_estimate(length_s, seed + 1000).K_rad_per_s_sqrt_s; });
    const auto unseen = std::ranges::count(K, 0.0);
    std::printf("unseen in %ld of %zu records\n", static_cast<long>(unseen), records);
    EXPECT_LE(unseen, 20) << "one in twenty; 20 is three standard deviations above";
}

TEST(WalkKnowledge, LawsGiveBackTheCoefficientsTheyCameFrom) {
    PowerLawLevels laws;
    const DeviationRule& rule = rule_of(DeviationKind::overlapping);
    laws.level[index_of(PowerLaw::white_rate)] = 4e-4;
    laws.level[index_of(PowerLaw::flicker_rate)] = 3e-6;
    laws.level[index_of(PowerLaw::rate_walk)] = 2e-9;
    const NoiseCoefficients noise = coefficients_of(laws, 10.0);
    for (const std::int64_t m : {100, 10'000}) {
        double variance = 0.0;
        for (const double share : laws.shares(rule, m)) { variance += share; }
        EXPECT_NEAR(noise.allan_variance(static_cast<double>(m) / 10.0), variance, 1e-3 * variance) << m;
    }
}

}  // namespace
}  // namespace gyrolog
