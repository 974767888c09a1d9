#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

#include <cmath>
#include <functional>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/estimators/random_telegraph.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/selection/better_shape.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t samples = 120000;
constexpr double far_better_nats = 8.0;

SensorModel quiet_sensor() {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise.K_rad_per_s_sqrt_s = 0.3e-4 * rad_per_deg; }
    return model;
}

// The recording with a course of the bias, in deg/s by seconds, on the x axis.
std::shared_ptr<const Recording> with_course(const std::shared_ptr<const Recording>& recording,
                                             const std::function<double(double)>& course_dps) {
    auto changed = std::make_shared<Recording>(*recording);
    for (Column& column : changed->columns) {
        if (column.name != gyro_columns[0]) { continue; }
        std::visit(
            [&](auto& data) {
                for (std::size_t row = 0; row < data.size(); ++row) {
                    const double more = course_dps(static_cast<double>(row) / changed->rate_hz);
                    const double value = static_cast<double>(data[row]) + more * rad_per_deg / column.scale;
                    data[row] = static_cast<std::decay_t<decltype(data[row])>>(std::round(value));
                }
            },
            column.data);
    }
    return changed;
}

struct Contest {
    std::optional<Finding> effect;
    std::optional<NonparametricFit> rival;

    double lead_nats() const { return (rival ? rival->evidence_nats : 0.0) - evidence(effect); }
};

Contest contest(EstimatorMaker make, const char* effect, const std::shared_ptr<const Recording>& recording) {
    const SensorModel model = quiet_sensor();
    Contest result{found(make, effect, recording, model), {}};
    const SensorModel with = result.effect ? with_cause(model, *result.effect) : model;
    result.rival = best_nonparametric(Observation(prediction_of(recording, model), recording, 1),
                                      Observation(prediction_of(recording, with), recording, 1));
    return result;
}

TEST(NonparametricAlternatives, SettlingsThatComeBackAreNoTelegraph) {
    const auto recording = with_course(recorded(quiet_sensor(), samples, 3), [](double t_s) {
        return 0.02 * std::exp(-std::fmod(t_s + 40.0, 131.0) / 30.0);
    });
    const Contest seen = contest(make_random_telegraph_estimator, "rtn", recording);
    EXPECT_GT(evidence(seen.effect), 20.0);
    EXPECT_GT(seen.lead_nats(), far_better_nats);
    ASSERT_TRUE(seen.rival.has_value());
    EXPECT_THAT(seen.rival->words, HasSubstr("repeats every 131"));
}

TEST(NonparametricAlternatives, ASwingThatGrowsFasterIsNoWalk) {
    const auto recording = with_course(recorded(quiet_sensor(), samples, 4), [](double t_s) {
        const double share = t_s / 1200.0;
        return 0.01 * (0.3 + 0.7 * share) * std::sin(30.0 * share * (0.6 + 0.6 * share));
    });
    const Contest seen = contest(make_noise_spectrum_estimator, "rrw_missing", recording);
    EXPECT_GT(evidence(seen.effect), 10.0);
    EXPECT_GT(seen.lead_nats(), far_better_nats);
    ASSERT_TRUE(seen.rival.has_value());
    EXPECT_THAT(seen.rival->words, HasSubstr("density rises"));
}

TEST(NonparametricAlternatives, WhatATurnLeavesBehindIsNoWalk) {
    const auto turns = [](double t_s) {
        return std::fmod(t_s + 50.0 * std::sin(t_s / 97.0), 140.0) < 20.0 ? 3.0 : 0.1;
    };
    const auto world = world_turning([&](double t_s) {
        const double rate_rad_s = turns(t_s) * std::sin(2.0 * pi * 0.7 * t_s);
        return Vector3{rate_rad_s, 0.3 * rate_rad_s, 0.2 * rate_rad_s};
    });
    double left_dps = 0.0;
    const auto recording = with_course(recorded(quiet_sensor(), samples / 2, 5, world), [&](double t_s) {
        left_dps += 0.01 / 14.0 * ((turns(t_s) > 1.0 ? 0.02 : 0.0) - left_dps);
        return left_dps;
    });
    const Contest seen = contest(make_noise_spectrum_estimator, "rrw_missing", recording);
    EXPECT_GT(seen.lead_nats(), far_better_nats);
    ASSERT_TRUE(seen.rival.has_value());
    EXPECT_THAT(seen.rival->words, HasSubstr("fades in some"));
}

// Of noise that is what it seems no other shape tells more.
class GenuineNoise : public testing::TestWithParam<std::uint64_t> {};

TEST_P(GenuineNoise, IsNoOtherShape) {
    const auto telegraph = recorded(
        with_effect(quiet_sensor(), "rtn",
                    {{"amplitude_dps", 0.008}, {"dwell_high_s", 30.0}, {"dwell_low_s", 20.0}}, {"x"}),
        samples, GetParam());
    const Contest levels = contest(make_random_telegraph_estimator, "rtn", telegraph);
    EXPECT_GT(evidence(levels.effect), 20.0);
    EXPECT_LT(levels.lead_nats(), far_better_nats);
    const auto wandering =
        recorded(with_effect(quiet_sensor(), "gauss_markov", {{"sigma_dps", 0.004}, {"tau_s", 8.0}}, {"x"}),
                 samples, GetParam());
    const Contest walk = contest(make_noise_spectrum_estimator, "gauss_markov", wandering);
    EXPECT_GT(evidence(walk.effect), 20.0);
    EXPECT_LT(walk.lead_nats(), far_better_nats);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GenuineNoise, testing::Values(11U, 12U, 13U, 14U));

// A course that repeats, which no effect has.
TEST(BetterShape, StandsBesideTheModelWithoutACause) {
    const SensorModel model = quiet_sensor();
    const auto recording = with_course(
        recorded(model, samples, 3), [](double t_s) { return 0.02 * (t_s / 40.0 - std::floor(t_s / 40.0)); });
    const auto given = prediction_of(recording, model);
    CauseSelection none;
    none.without_causes = model;
    const auto shape = better_shape(none, given, recording, {.threads = 1});
    ASSERT_TRUE(shape);
    EXPECT_TRUE(shape->than.empty());
}

// The likelihood is of fewer samples with repeats in the model, which leaves them out: what the other causes
// gain by together is not seen in the difference to a model without any.
TEST(BetterShape, HoldsLikelihoodsOfTheSameSamplesAgainstEachOther) {
    const SensorModel model = quiet_sensor();
    SensorModel sensor = with_effect(model, "flicker_missing", {{"B_dps", 0.01}}, {});
    sensor = with_effect(sensor, "gauss_markov", {{"sigma_dps", 0.03}, {"tau_s", 1.0}}, {});
    sensor = with_effect(sensor, "stale", {{"eps", 0.002}}, {});
    const auto recording = recorded(sensor, 30000, 71);
    const auto given = prediction_of(recording, model);
    const auto found = select_causes(examine(given, recording, 1, 1), recording, {.threads = 1});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 3U);
    const auto shape = better_shape(*found, given, recording, {.threads = 1});
    EXPECT_FALSE(shape) << shape->words << " by " << shape->evidence_nats << " nats";
}

}  // namespace
}  // namespace gyrolog
