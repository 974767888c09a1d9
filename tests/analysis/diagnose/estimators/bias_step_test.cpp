#include "analysis/diagnose/estimators/bias_step.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/estimators/step_scan.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

SensorModel white_sensor() {
    SensorModel model = typical_mpu9250();
    for (AxisModel& axis : model.axes) {
        axis.noise = {};
        axis.noise.N_rad_per_sqrt_s = 0.005 * rad_per_deg;
    }
    model.sd_rel = {{"N", 0.005}};
    return model;
}

TEST(StepCoefficient, IsTheCosineTransformOfAJump) {
    constexpr std::size_t length = 240;
    CosineTransform transform(length);
    for (const std::size_t at : {std::size_t{1}, std::size_t{77}, std::size_t{239}}) {
        std::vector<double> jump(length, 0.0);
        for (std::size_t i = at; i < length; ++i) { jump[i] = 1.0; }
        transform.forward(jump);
        for (std::size_t k = 1; k < length; ++k) {
            EXPECT_NEAR(step_coefficient(length, static_cast<double>(at), k), jump[k], 1e-9)
                << at << " " << k;
        }
    }
}

TEST(StepScan, IsLeastSquaresAtEveryMoment) {
    constexpr std::size_t length = 1000;
    constexpr std::size_t used = 64;
    const RandomStream noise(1, 2);
    std::vector<float> cosines(length);
    for (std::size_t k = 0; k < length; ++k) { cosines[k] = static_cast<float>(noise.normal(k)); }
    std::vector<double> weights(used);
    for (std::size_t k = 0; k < used; ++k) { weights[k] = 1.0 + 0.1 * static_cast<double>(k); }
    StepScan scan(length, used);
    const StepScan::Fit fit = scan.fit(cosines, weights);
    ASSERT_EQ(fit.pull.size(), scan.places());
    for (std::size_t place = 0; place < scan.places(); ++place) {
        double pull = 0.0;
        double information = 0.0;
        for (std::size_t k = 1; k <= used; ++k) {
            const double g = step_coefficient(length, scan.sample_at(place), k);
            pull += weights[k - 1] * g * static_cast<double>(cosines[k]);
            information += weights[k - 1] * g * g;
        }
        EXPECT_NEAR(fit.pull[place], pull, 1e-7 * std::sqrt(information) + 1e-9);
        EXPECT_NEAR(fit.information[place], information, 1e-9 * fit.information[scan.places() / 2]);
    }
}

TEST(BiasStep, GainsInWhiteNoiseWhatTheJumpIsWorth) {
    constexpr double n = 60000.0;
    constexpr double before = 21000.0;
    constexpr double step_dps = 0.004;
    const SensorModel model = white_sensor();
    const SensorModel truth =
        with_effect(model, "bias_step", {{"step_dps", step_dps}, {"at_s", (before - 0.5) / 100.0}}, {"y"});
    const double lsb_dps = model.lsb_rad_s * deg_per_rad;
    const double variance = 0.005 * 0.005 * 100.0 + lsb_dps * lsb_dps / 12.0;
    const double ideal = 0.5 * step_dps * step_dps * before * (n - before) / (n * variance);
    double sum = 0.0;
    constexpr int seeds = 8;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const auto finding = found(make_bias_step_estimator, "bias_step",
                                   recorded(truth, static_cast<std::uint64_t>(n), seed), model);
        ASSERT_TRUE(finding);
        EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{1});
        sum += finding->axis_gain_nats[1];
    }
    // Two parameters were fitted.
    EXPECT_NEAR(sum / seeds, ideal + 1.0, 4.0 * std::sqrt(2.0 * ideal / seeds));
}

TEST(BiasStep, FindsMomentHeightsAndAxes) {
    const SensorModel model = calibrated_sensor();
    SensorModel truth = with_effect(model, "bias_step", {{"step_dps", 0.03}, {"at_s", 400.0}}, {"x"});
    truth = with_effect(truth, "bias_step", {{"step_dps", -0.02}, {"at_s", 400.0}}, {"z"});
    const auto recording = recorded(truth, 90000, 3);
    const auto finding = found(make_bias_step_estimator, "bias_step", recording, model);
    ASSERT_TRUE(finding);
    ASSERT_EQ(finding->where.axes, (std::vector<std::size_t>{0, 2}));
    const std::array<double, 2> step_dps = {0.03, -0.02};
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(finding->entries[i].params.at("step_dps"), step_dps[i],
                    4.0 * finding->sd[i].at("step_dps"));
        EXPECT_NEAR(finding->entries[i].params.at("at_s"), 400.0, 5.0 * finding->sd[i].at("at_s"));
        EXPECT_LT(finding->sd[i].at("at_s"), 0.5);
    }
    ASSERT_TRUE(finding->where.time_s);
    EXPECT_NEAR(finding->where.time_s->from, 400.0, 1.0);
    EXPECT_LT(evidence(found(make_bias_step_estimator, "bias_step", recording, with_cause(model, *finding))),
              3.0);
}

// A sample on the wrong side would be an outlier of its own.
TEST(BiasStep, FindsAHighJumpToTheSample) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(model, "bias_step", {{"step_dps", 0.5}, {"at_s", 333.335}});
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto finding =
            found(make_bias_step_estimator, "bias_step", recorded(truth, 60000, seed), model);
        ASSERT_TRUE(finding);
        EXPECT_EQ(finding->entries.size(), 1U);
        EXPECT_NEAR(finding->entries.front().params.at("at_s"), 333.335, 0.004);
    }
}

// The random walk of the model is known to a factor only: the jump is seen all the same, and a walk that is
// faster than the model's is better explained by one.
TEST(BiasStep, YieldsToARandomWalk) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(model, "rrw_missing", {{"K_dps_sqrt_hz", 1e-3}});
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto recording = recorded(truth, 60000, seed);
        const auto walk = found(make_noise_spectrum_estimator, "rrw_missing", recording, model);
        ASSERT_TRUE(walk);
        EXPECT_GT(evidence(walk),
                  evidence(found(make_bias_step_estimator, "bias_step", recording, model)) + 20.0);
    }
}

// An axis of three has it or has it not; of one axis there is nothing to choose.
TEST(BiasStep, PaysForTheChoiceOfAxesWhereThereIsOne) {
    const SensorModel model = calibrated_sensor();
    const SensorModel sensor = with_effect(model, "bias_step", {{"step_dps", 0.1}, {"at_s", 33.0}}, {"x"});
    const Recording whole = *recorded(sensor, 8192, 12);
    Recording alone = whole;
    alone.columns.erase(alone.columns.begin() + 1, alone.columns.begin() + 3);
    const auto of_three =
        found(make_bias_step_estimator, "bias_step", std::make_shared<const Recording>(whole), model);
    const auto of_one =
        found(make_bias_step_estimator, "bias_step", std::make_shared<const Recording>(alone), model);
    ASSERT_TRUE(of_three && of_one);
    ASSERT_EQ(of_three->where.axes, std::vector<std::size_t>{0});
    EXPECT_NEAR(of_one->gain_nats, of_three->gain_nats, 0.05);
    EXPECT_NEAR(of_one->evidence_nats - of_three->evidence_nats, std::log(2.0), 0.1);
}

TEST(BiasStep, AnswersForOneDeadAxisAndFewSamples) {
    const SensorModel model = calibrated_sensor();
    EXPECT_LT(evidence(found(make_bias_step_estimator, "bias_step", few_samples_with_a_dead_axis(model, 10),
                             model)),
              3.0);
    const SensorModel sensor = with_effect(model, "bias_step", {{"at_s", 9.0}, {"step_dps", 0.1}}, {"z"});
    const auto finding =
        found(make_bias_step_estimator, "bias_step", few_samples_with_a_dead_axis(sensor, 10), model);
    ASSERT_TRUE(finding);
    EXPECT_TRUE(std::isfinite(finding->evidence_nats));
    EXPECT_GT(finding->evidence_nats, 20.0);
    EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace gyrolog
