#include "analysis/diagnose/selection/asked_effect.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t samples = 12'000;

SensorModel white_sensor() {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    model.sd_rel = {};
    return model;
}

SensorModel with(SensorModel model, const EffectModel& entry) {
    model.effects.push_back(entry);
    return model;
}

Asked::Answer asked_of(const SensorModel& sensor, const EffectModel& entry, std::uint64_t seed) {
    const auto recording = recorded(sensor, samples, seed);
    const Observation observation(prediction_of(recording, white_sensor()), recording, 1);
    return asked({"", entry}, observation, observation).beside;
}

// Each is seen at some five standard deviations.
std::vector<EffectModel> described() {
    return {
        {"time_table",
         {"z"},
         {},
         "",
         {{"t_s", {0.0, 30.0, 60.0, 90.0}}, {"bias_dps", {0.0, 0.01, -0.01, 0.01}}}},
        {"density_table",
         {"x"},
         {},
         "",
         {{"f_hz", {0.0, 20.0, 30.0, 50.0}}, {"factor", {1.0, 1.0, 1.25, 1.0}}}},
    };
}

// Of 60 draws, the number that a share of them gives lies within 4 binomial standard deviations.
void expect_share(int count, double share) {
    EXPECT_NEAR(count, 60.0 * share, 4.0 * std::sqrt(60.0 * share * (1.0 - share)));
}

TEST(AskedEffect, HasItsAmountWithinItsUncertainty) {
    for (const EffectModel& entry : described()) {
        int within_one = 0;
        int called = 0;
        for (std::uint64_t seed = 1; seed <= 60; ++seed) {
            const Asked::Answer answer = asked_of(with(white_sensor(), entry), entry, seed);
            ASSERT_TRUE(answer.amount);
            const double off = std::fabs(answer.amount->value - 1.0);
            within_one += off < answer.amount->sd ? 1 : 0;
            EXPECT_LT(off, 4.5 * answer.amount->sd) << entry.effect << " seed " << seed;
            called += answer.is_called_for ? 1 : 0;
        }
        expect_share(within_one, 0.683);
        EXPECT_GE(called, 50) << entry.effect;
    }
}

TEST(AskedEffect, IsCalledForByChanceAsSeldomAsStated) {
    int called = 0;
    int below_half = 0;
    for (const EffectModel& entry : described()) {
        for (std::uint64_t seed = 101; seed <= 130; ++seed) {
            const Asked::Answer answer = asked_of(white_sensor(), entry, seed);
            called += answer.is_called_for ? 1 : 0;
            below_half += answer.p < 0.5 ? 1 : 0;
        }
    }
    EXPECT_LE(called, 2);  // 60 of which one in 370 is
    expect_share(below_half, 0.5);
}

TEST(AskedEffect, WithoutASizeIsTakenAsItIsDescribed) {
    const EffectModel filter{"biquad", {}, {{"b0", 0.9}, {"b1", 0.1}}, "", {}};
    const Asked::Answer there = asked_of(with(white_sensor(), filter), filter, 1);
    EXPECT_TRUE(there.is_called_for);
    EXPECT_FALSE(there.amount);
    EXPECT_EQ(there.gain_nats, there.described_nats);
    const Asked::Answer absent = asked_of(white_sensor(), filter, 1);
    EXPECT_FALSE(absent.is_called_for);
    EXPECT_LT(absent.gain_nats, -10.0);
    EXPECT_EQ(absent.p, 1.0);
}

// What the causes hold is not called for a second time.
TEST(AskedEffect, IsAskedForBesideTheCauses) {
    const EffectModel entry = described().front();
    const auto recording = recorded(with(white_sensor(), entry), samples, 3);
    const Observation alone(prediction_of(recording, white_sensor()), recording, 1);
    const Asked answer = asked({"heater", entry}, alone.under(with(white_sensor(), entry)), alone);
    EXPECT_FALSE(answer.beside.is_called_for);
    EXPECT_NEAR(answer.beside.amount->value, 0.0, 4.0 * answer.beside.amount->sd);
    EXPECT_TRUE(answer.alone.is_called_for);
    EXPECT_NEAR(answer.alone.amount->value, 1.0, 4.0 * answer.alone.amount->sd);
    EXPECT_EQ(answer.described.name, "heater");
}

}  // namespace
}  // namespace gyrolog
