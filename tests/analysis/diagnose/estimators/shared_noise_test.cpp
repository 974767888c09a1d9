#include "analysis/diagnose/estimators/shared_noise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

TEST(SharedNoiseEvidence, IsWhatTheCorrelationAndTheLevelGain) {
    const SensorModel model = known_sensor();
    const double own_dps = model.axes[0].noise.N_rad_per_sqrt_s * deg_per_rad;
    const double shared_dps = 0.3 * own_dps;
    const auto seen = seen_effects(model, {effect_entry("common_mode", {{"N_dps_per_sqrt_hz", shared_dps}})},
                                   half_hour, 51);
    const auto found = seen.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(found->where.structure, "cross_axis");
    ASSERT_EQ(found->entries.size(), 1U);
    EXPECT_FALSE(effect_refusal(found->entries[0]));
    EXPECT_NEAR(found->entries[0].params.at("N_dps_per_sqrt_hz"), shared_dps,
                4.0 * found->sd[0].at("N_dps_per_sqrt_hz"));
    // Axes that are alike, correlated by r: ln det = ln (1 - r)^2 (1 + 2 r).
    const double r = 0.09 / 1.09;
    const double ideal = -0.5 * static_cast<double>(seen.prediction->length()) *
                         std::log((1.0 - r) * (1.0 - r) * (1.0 + 2.0 * r));
    EXPECT_NEAR(found->gain_nats, ideal, 0.12 * ideal);
}

TEST(SharedNoiseEvidence, TellsTheGainsOfTheAxes) {
    const auto seen = seen_effects(
        known_sensor(),
        {effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.005}, {"gain_y", -0.6}, {"gain_z", 0.8}})},
        half_hour, 52);
    const auto found = seen.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(found);
    const auto& params = found->entries[0].params;
    const auto& sd = found->sd[0];
    EXPECT_NEAR(params.at("N_dps_per_sqrt_hz"), 0.005, 4.0 * sd.at("N_dps_per_sqrt_hz"));
    EXPECT_NEAR(params.at("gain_x"), 1.0, 1e-9);
    EXPECT_NEAR(params.at("gain_y"), -0.6, 4.0 * sd.at("gain_y"));
    EXPECT_NEAR(params.at("gain_z"), 0.8, 4.0 * sd.at("gain_z"));
}

// The sensor's filter follows the noise, whatever the model's list has first.
TEST(SharedNoiseEvidence, IsThatBeforeTheSensorsFilter) {
    const EffectModel filter = effect_entry("lowpass", {{"fc_hz", 9.0}, {"order", 1.0}});
    const EffectModel shared =
        effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.002}, {"gain_y", 0.6}, {"gain_z", 0.8}});
    SensorModel model = known_sensor();
    model.effects = {filter};
    const auto seen = seen_effects(model, {shared}, half_hour, 56);
    const auto found = seen.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(found);
    const auto& params = found->entries[0].params;
    const auto& sd = found->sd[0];
    for (const auto& [name, value] : shared.params) {
        EXPECT_NEAR(params.at(name), value, 4.0 * sd.at(name)) << name;
    }

    for (const std::vector<EffectModel>& list : {std::vector{filter, shared}, std::vector{shared, filter}}) {
        SensorModel whole = model;
        whole.effects = list;
        const auto with = seen_with(whole, seen.recording);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const AxisObservation& there = with.seen->axis(axis);
            for (std::size_t i = there.power.size() / 2; i < there.power.size(); ++i) {
                const double sd_rel = std::sqrt(2.0 / with.prediction->bins()[i].count());
                EXPECT_NEAR(there.power[i] / there.density[i], 1.0, 5.0 * sd_rel) << axis << " " << i;
            }
        }
    }
}

TEST(SharedNoiseEvidence, LeavesOutAnAxisThatHasNone) {
    const auto seen = seen_effects(known_sensor(),
                                   {effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.003}}, {"x", "z"})},
                                   half_hour, 53);
    const auto found = seen.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 2}));
}

TEST(SharedNoiseEvidence, IsNoneForAxesThatAreLouderEachByItself) {
    const EffectModel louder = effect_entry("arw_scale", {{"factor", 1.5}});
    const EffectModel shared = effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.003}});
    const auto both = seen_effects(known_sensor(), {louder, shared}, half_hour, 54);
    EXPECT_GT(both.evidence_nats("common_mode", make_shared_noise_estimator), 20.0);
    const auto seen = seen_effects(known_sensor(), {louder}, half_hour, 54);
    EXPECT_LT(seen.evidence_nats("common_mode", make_shared_noise_estimator), 2.0);
    EXPECT_GT(seen.evidence_nats("arw_scale", make_noise_spectrum_estimator), 20.0);
}

// A calibration of each axis by itself has the whole: nothing of it is too much.
TEST(SharedNoiseEvidence, MayBePartOfTheNoiseThatTheAxesHave) {
    const EffectModel part =
        effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.002}, {"gain_y", -0.7}, {"part_of_white", 1.0}});
    const auto seen = seen_effects(known_sensor(), {part}, half_hour, 57);
    const auto found = seen.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(found);
    const auto& params = found->entries[0].params;
    EXPECT_EQ(params.at("part_of_white"), 1.0);
    EXPECT_NEAR(params.at("N_dps_per_sqrt_hz"), 0.002, 4.0 * found->sd[0].at("N_dps_per_sqrt_hz"));
    EXPECT_GT(found->evidence_nats, 20.0);
    SensorModel with_it = known_sensor();
    with_it.effects = {found->entries[0]};
    const auto beside = seen_with(with_it, seen.recording);
    EXPECT_LT(beside.evidence_nats("arw_scale", make_noise_spectrum_estimator), 2.0);
    EXPECT_LT(beside.evidence_nats("common_mode", make_shared_noise_estimator), 2.0);
    // What is added is told from it.
    const auto louder = seen_effects(
        known_sensor(), {effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.002}})}, half_hour, 58);
    const auto added = louder.find("common_mode", make_shared_noise_estimator);
    ASSERT_TRUE(added);
    EXPECT_FALSE(added->entries[0].params.contains("part_of_white"));
}

TEST(SharedNoiseEvidence, IsGoneOnceTheModelHasIt) {
    SensorModel model = known_sensor();
    model.effects.push_back(effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.005}, {"gain_y", 0.5}}));
    const auto seen = seen_effects(model, {}, half_hour, 55);
    EXPECT_LT(seen.evidence_nats("common_mode", make_shared_noise_estimator), 2.0);
    const auto without = seen_with(known_sensor(), seen.recording);
    EXPECT_GT(without.evidence_nats("common_mode", make_shared_noise_estimator), 20.0);
}

}  // namespace
}  // namespace gyrolog
