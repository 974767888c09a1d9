#include "analysis/diagnose/likelihood/noise_refit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/random_telegraph.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t samples = 180'000;

Observation observed(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return {prediction_of(recording, model), recording, 1};
}

// As a fit to a recording states it that had telegraph noise: B for the most part, and sure of it.
SensorModel fitted_to_telegraph_noise() {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = 0.0084 * rad_per_deg; }
    model.sd_rel["B"] = 0.02;
    return model;
}

SensorModel telegraph_sensor() {
    SensorModel sensor = calibrated_sensor();
    sensor.effects.push_back(
        {"rtn", {}, {{"amplitude_dps", 0.02}, {"dwell_high_s", 1.6}, {"dwell_low_s", 2.6}}, ""});
    return sensor;
}

TEST(NoiseRefit, IsRareInASensorThatIsAsItsModelSays) {
    constexpr std::uint64_t seeds = 20;
    const SensorModel model = calibrated_sensor();
    std::size_t axes = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        axes += axes_to_refit(observed(recorded(model, 30'000, seed), model)).size();
    }
    EXPECT_LE(axes, 2U) << "of " << 3 * seeds << ", five nats each";
}

TEST(NoiseRefit, IsOnTheAxesThatTheModelHasTooNoisy) {
    const auto recording = recorded(calibrated_sensor(), samples, 31);
    SensorModel model = calibrated_sensor();
    model.axes[1].noise.B_rad_per_s *= 4.0;
    EXPECT_EQ(axes_to_refit(observed(recording, model)), std::vector<std::size_t>{1});
    // More noise than the model has is no such case.
    model.axes[1].noise.B_rad_per_s /= 16.0;
    EXPECT_TRUE(axes_to_refit(observed(recording, model)).empty());
}

TEST(NoiseRefit, SetFreeComesToWhatTheSensorHas) {
    const SensorModel sensor = calibrated_sensor();
    const auto recording = recorded(sensor, samples, 32);
    SensorModel model = sensor;
    model.axes[2].noise.B_rad_per_s *= 4.0;
    const std::vector<std::size_t> axes = {2};
    const std::vector<NoiseRefit> fitted = fitted_noise(
        observed(recording, with_free_noise(model, observed(recording, model), axes)), model, axes);
    ASSERT_EQ(fitted.size(), 3U);
    const NoiseCoefficients& truth = sensor.axes[2].noise;
    const std::vector<double> true_values = {truth.N_rad_per_sqrt_s, truth.B_rad_per_s,
                                             truth.K_rad_per_s_sqrt_s};
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        EXPECT_EQ(fitted[i].coefficient, "NBK"[i]);
        EXPECT_NEAR(fitted[i].fitted, true_values[i], 4.0 * fitted[i].fitted_sd) << "NBK"[i];
    }
    EXPECT_LT(fitted[1].fitted_sd, 0.5 * true_values[1]);
    const SensorModel restated = with_noise(model, fitted);
    EXPECT_EQ(restated.axes[2].noise.B_rad_per_s, fitted[1].fitted);
    EXPECT_EQ(restated.axes[2].sd_rel.at("B"), fitted[1].fitted_sd / fitted[1].fitted);
    EXPECT_EQ(restated.axes[0].noise.B_rad_per_s, model.axes[0].noise.B_rad_per_s);
    EXPECT_TRUE(axes_to_refit(observed(recording, restated)).empty());
}

// As a fit may state it that took all for flicker noise: a sensor without white noise is none.
TEST(NoiseRefit, MayBeAllThatThereIs) {
    const SensorModel sensor = calibrated_sensor();
    const auto recording = recorded(sensor, samples, 33);
    SensorModel model = sensor;
    NoiseCoefficients& stated = model.axes[1].noise;
    stated = {};
    stated.B_rad_per_s = 0.05 * rad_per_deg;
    model.axes[1].sd_rel = {{"N", 1.0}, {"B", 0.02}, {"K", 1.0}};
    const Observation seen = observed(recording, model);
    const std::vector<std::size_t> axes = {1};
    ASSERT_EQ(axes_to_refit(seen), axes);
    const std::vector<NoiseRefit> fitted =
        fitted_noise(observed(recording, with_free_noise(model, seen, axes)), model, axes);
    ASSERT_EQ(fitted.size(), 3U);
    const NoiseCoefficients& truth = sensor.axes[1].noise;
    const std::vector<double> true_values = {truth.N_rad_per_sqrt_s, truth.B_rad_per_s,
                                             truth.K_rad_per_s_sqrt_s};
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        EXPECT_EQ(fitted[i].stated, i == 1 ? stated.B_rad_per_s : 0.0);
        EXPECT_NEAR(fitted[i].fitted, true_values[i], 4.0 * fitted[i].fitted_sd) << "NBK"[i];
    }
    EXPECT_LT(fitted[0].fitted_sd, 0.01 * true_values[0]);
}

// Four times as much as stated at most, but as little as there is.
TEST(NoiseRefit, SetFreeGrowsLittleAndShrinksMuch) {
    SensorModel sensor = calibrated_sensor();
    sensor.axes[1].noise.K_rad_per_s_sqrt_s *= 20.0;
    const auto recording = recorded(sensor, samples, 37);
    SensorModel model = sensor;
    model.axes[1].noise.K_rad_per_s_sqrt_s /= 10.0;
    model.axes[2].noise.B_rad_per_s *= 200.0;
    const SensorModel freed = with_free_noise(model, observed(recording, model), {1, 2});
    const std::vector<NoiseRefit> fitted = fitted_noise(observed(recording, freed), model, {1, 2});
    ASSERT_EQ(fitted.size(), 6U);
    EXPECT_NEAR(fitted[2].fitted, 4.0 * model.axes[1].noise.K_rad_per_s_sqrt_s,
                1e-3 * model.axes[1].noise.K_rad_per_s_sqrt_s);
    EXPECT_LT(fitted[4].fitted, 2.0 * sensor.axes[2].noise.B_rad_per_s);
}

// A fit may give flicker noise to the walk: set free, it is there again.
TEST(NoiseRefit, LeavesRoomForWhatIsStatedAsNothing) {
    const SensorModel sensor = calibrated_sensor();
    const auto recording = recorded(sensor, samples, 36);
    SensorModel model = sensor;
    model.axes[0].noise.B_rad_per_s = 0.0;
    model.axes[0].noise.K_rad_per_s_sqrt_s *= 10.0;
    model.axes[0].sd_rel = {{"N", 0.005}, {"B", 1.0}, {"K", 0.06}};
    const Observation seen = observed(recording, model);
    const std::vector<std::size_t> axes = {0};
    ASSERT_EQ(axes_to_refit(seen), axes);
    const std::vector<NoiseRefit> fitted =
        fitted_noise(observed(recording, with_free_noise(model, seen, axes)), model, axes);
    ASSERT_EQ(fitted.size(), 3U);
    const NoiseCoefficients& truth = sensor.axes[0].noise;
    EXPECT_NEAR(fitted[1].fitted, truth.B_rad_per_s, 4.0 * fitted[1].fitted_sd);
    EXPECT_LT(fitted[1].fitted_sd, 0.3 * truth.B_rad_per_s);
    EXPECT_NEAR(fitted[2].fitted, truth.K_rad_per_s_sqrt_s, 4.0 * fitted[2].fitted_sd);
}

// Held to the model's B, telegraph noise comes out too small, and what is simulated with it too noisy.
TEST(ForwardSelection, TakesOffTheModelWhatItsFitMadeOfTheCause) {
    const auto recording = recorded(telegraph_sensor(), samples, 33);
    const SensorModel model = fitted_to_telegraph_noise();
    const auto prediction = prediction_of(recording, model);
    const Hypotheses first = examine(prediction, recording, 1, 1);
    const std::optional<CauseSelection> found = select_causes(first, recording, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 1U);
    const Finding& cause = found->causes.front().finding;
    EXPECT_EQ(cause.effect, "rtn");
    EXPECT_NEAR(cause.entries.front().params.at("amplitude_dps"), 0.02,
                4.0 * cause.sd.front().at("amplitude_dps"));
    EXPECT_EQ(found->noise_refits.size(), 9U) << "N, B and K of three axes";
    for (const AxisModel& axis : found->corrected.axes) {
        EXPECT_LT(axis.noise.B_rad_per_s, 0.5 * model.axes[0].noise.B_rad_per_s);
    }
}

TEST(ForwardSelection, LeavesTheNoiseOfAModelThatIsRight) {
    const auto recording = recorded(telegraph_sensor(), samples, 34);
    const Hypotheses first = examine(prediction_of(recording, calibrated_sensor()), recording, 1, 1);
    const std::optional<CauseSelection> found = select_causes(first, recording, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 1U);
    EXPECT_TRUE(found->noise_refits.empty());
}

// With N, B and K free, noise without a telegraph explains most of one; noise that goes with it explains
// less.
TEST(NoiseRefit, SetFreeLeavesTheTelegraphItsDwellTimes) {
    SensorModel sensor = calibrated_sensor(0.003);
    sensor.effects.push_back(
        {"rtn", {"z"}, {{"amplitude_dps", 0.04}, {"dwell_high_s", 2.4}, {"dwell_low_s", 2.0}}, ""});
    const auto recording = recorded(sensor, samples, 35);
    SensorModel model = calibrated_sensor(0.003);
    model.axes[2].noise.B_rad_per_s = 0.012 * rad_per_deg;
    model.axes[2].noise.K_rad_per_s_sqrt_s = 0.0;
    const SensorModel freed = with_free_noise(model, observed(recording, model), {2});
    const std::optional<Finding> finding = found(make_random_telegraph_estimator, "rtn", recording, freed);
    ASSERT_TRUE(finding);
    ASSERT_EQ(finding->entries.size(), 1U);
    const std::map<std::string, double>& params = finding->entries[0].params;
    EXPECT_NEAR(params.at("amplitude_dps"), 0.04, 0.001);
    EXPECT_NEAR(params.at("dwell_high_s"), 2.4, 5.0 * 2.4 / std::sqrt(1800.0 / 4.4));
    EXPECT_NEAR(params.at("dwell_low_s"), 2.0, 5.0 * 2.0 / std::sqrt(1800.0 / 4.4));
}

// Without any, Gauss-Markov noise of a few samples would do what a low-pass does.
TEST(NoiseRefit, LeavesAQuarterOfTheWhiteNoise) {
    const SensorModel model = calibrated_sensor();
    SensorModel quiet = model;
    for (AxisModel& axis : quiet.axes) { axis.noise.N_rad_per_sqrt_s *= 0.05; }
    const auto recording = recorded(quiet, 60'000, 8);
    const auto prediction = prediction_of(recording, model);
    const SensorModel free = with_free_noise(model, Observation(prediction, recording, 1), {0});
    const auto fitted = fitted_noise(Observation(prediction->with(free), recording, 1), free, {0});
    EXPECT_NEAR(fitted[0].fitted / model.axes[0].noise.N_rad_per_sqrt_s, 0.25, 1e-6);
}

}  // namespace
}  // namespace gyrolog
