#include "analysis/diagnose/estimators/variance_with_temperature.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/tails.hpp"
#include "analysis/diagnose/estimators/variance_change_point.hpp"
#include "analysis/diagnose/likelihood/variance_fit.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t hour = 360'000;  // samples

TEST(VarianceWithTemperature, IsTheLikelihoodRatio) {
    const auto seen =
        seen_effects(known_sensor(), {effect_entry("temp_noise", {{"per_C", 0.01}, {"reference_C", 30.0}})},
                     hour, 41, swept_temperature());
    const auto found = seen.find("temp_noise", make_variance_with_temperature_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(found->where.temperature);
    ASSERT_EQ(found->entries.size(), 1U);
    EXPECT_FALSE(effect_refusal(found->entries[0]));
    const auto& params = found->entries[0].params;
    // The change relative to the noise at one temperature is another at another.
    const double at_30 = params.at("per_C") / (1.0 + params.at("per_C") * (30.0 - params.at("reference_C")));
    EXPECT_NEAR(at_30, 0.01, 4.0 * found->sd[0].at("per_C"));
    // n ln(sigma) has the information 2 n: n (per_C)^2 times the variance of the temperature, 25 / 3.
    const double ideal = 3.0 * static_cast<double>(hour) * 1e-4 * 25.0 / 3.0;
    EXPECT_NEAR(found->gain_nats, ideal, 0.15 * ideal);
}

TEST(VarianceWithTemperature, CountsFromTheModelsReferenceWhereTheLevelSaysSo) {
    SensorModel model = known_sensor();
    model.sd_rel["N"] = 0.001;
    model.temperature = TemperatureModel{};
    model.temperature->reference_C = 20.0;
    const auto seen =
        seen_effects(model, {effect_entry("temp_noise", {{"per_C", 0.01}})}, hour, 42, swept_temperature());
    const auto found = seen.find("temp_noise", make_variance_with_temperature_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->entries[0].params.at("reference_C"), 20.0);
    EXPECT_NEAR(found->entries[0].params.at("per_C"), 0.01, 4.0 * found->sd[0].at("per_C"));
}

TEST(VarianceWithTemperature, IsMoreThanThatOfACourseInTimeAndOfTails) {
    const auto seen = seen_effects(known_sensor(), {effect_entry("temp_noise", {{"per_C", 0.01}}, {"z"})},
                                   hour, 43, swept_temperature());
    const auto found = seen.find("temp_noise", make_variance_with_temperature_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, std::vector<std::size_t>{2});
    const auto course = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(course);
    EXPECT_LT(course->evidence_nats, found->evidence_nats - 20.0);
    EXPECT_LT(seen.evidence_nats("heavy_tail", make_tail_estimator), 0.5 * found->evidence_nats);
    const auto both = seen_effects(known_sensor(),
                                   {effect_entry("temp_noise", {{"per_C", 0.01}}, {"z"}),
                                    effect_entry("heavy_tail", {{"nu", 5.0}}, {"z"})},
                                   hour, 43, swept_temperature());
    EXPECT_GT(both.evidence_nats("heavy_tail", make_tail_estimator), 100.0);
}

TEST(VarianceWithTemperature, NeedsATemperatureThatChanges) {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double) { return 30.0; };
    const auto seen = seen_effects(known_sensor(), {}, 20'000, 44, world);
    EXPECT_EQ(seen.untestable("temp_noise", make_variance_with_temperature_estimator),
              "the temperature hardly changes");
}

TEST(VarianceWithTemperature, IsGoneOnceTheModelHasIt) {
    SensorModel model = known_sensor();
    model.effects.push_back(effect_entry("temp_noise", {{"per_C", 0.02}}));
    const auto seen = seen_effects(model, {}, hour, 45, swept_temperature());
    EXPECT_LT(seen.evidence_nats("temp_noise", make_variance_with_temperature_estimator), 3.0);
    const auto without = seen_with(known_sensor(), seen.recording);
    EXPECT_GT(without.evidence_nats("temp_noise", make_variance_with_temperature_estimator), 20.0);
}

// Blocks of 200 normal samples; their level swings by `swing`, `swings` times.
WhitenedBlocks blocks_with_swing(std::uint64_t seed, double swing, double swings) {
    constexpr std::size_t count = 1024;
    constexpr double samples = 200.0;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    WhitenedBlocks blocks;
    for (std::size_t i = 0; i < count; ++i) {
        const double turns = swings * static_cast<double>(i) / static_cast<double>(count);
        blocks.variance.push_back((1.0 + std::sqrt(2.0 / samples) * normal(random)) *
                                  (1.0 + swing * std::sin(2.0 * M_PI * turns)));
        blocks.weight.push_back(samples);
        blocks.mean.push_back(0.0);
    }
    return blocks;
}

// A level that swings by half of what chance has from block to block hardly shows there: it does in sums.
TEST(Overdispersion, IsSeenInSumsOfBlocks) {
    const std::vector<double> level(1024, 1.0);
    int false_alarms = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        if (overdispersion(blocks_with_swing(seed, 0.0, 1.0), level) > 1.0) { ++false_alarms; }
    }
    EXPECT_LE(false_alarms, 3);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        // Of single blocks 1.1, of sums of 64 blocks 1 + 64 swing^2 / 2 over the 2 / 200 of one.
        const double dispersion = overdispersion(blocks_with_swing(seed, 0.05, 2.0), level);
        EXPECT_GT(dispersion, 5.0) << seed;
        EXPECT_LT(dispersion, 13.0) << seed;
    }
}

}  // namespace
}  // namespace gyrolog
