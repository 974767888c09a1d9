#include "analysis/diagnose/estimators/disturbance.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/selection/cause_set.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t two_minutes = 12'000;  // samples

SensorModel bumped(const SensorModel& model) {
    return with_effect(model, "disturbance",
                       {{"per_hour", 120.0}, {"size_dps", 1.0}, {"decay_s", 0.3}, {"f_hz", 8.0}}, {});
}

TEST(Disturbance, IsTheOnlyCauseOfBumps) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(bumped(model), two_minutes, 3);
    DiagnosisOptions options;
    options.simulations = 60;
    const auto diagnosis = diagnose(recording, model, "model.json", options);
    ASSERT_TRUE(diagnosis);
    EXPECT_EQ(diagnosis->verdict, Verdict::known);
    ASSERT_EQ(diagnosis->causes.size(), 1U);
    const Cause& cause = diagnosis->causes.front();
    EXPECT_EQ(cause.finding.effect, "disturbance");
    EXPECT_GT(cause.share.value, 0.9);
    EXPECT_GT(cause.score, 0.9);
    ASSERT_TRUE(cause.finding.where.time_s);
    // The corrected model leaves them out and simulates none.
    EXPECT_EQ(cause.finding.entries.front().params.at("simulated"), 0.0);
}

// A second recording's bumps lie elsewhere: they are found in it and left out as well.
// The stretches that are left out are filled with noise. That of a model without the filter is thirty times
// too loud near half the rate: the filter was found 5 standard deviations off, and coloured noise, which has
// a floor, was the likelier cause.
TEST(Disturbance, LeavesAFilterBesideItAsItIs) {
    const SensorModel model = calibrated_sensor();
    const SensorModel sensor = with_effect(
        with_effect(model, "disturbance",
                    {{"per_hour", 60.0}, {"size_dps", 2.0}, {"decay_s", 0.17}, {"f_hz", 20.0}}, {}),
        "lowpass", {{"fc_hz", 5.7}, {"order", 1.0}}, {});
    const auto recording = recorded(sensor, 60'000, 3);
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    const auto finding_of = [](const Hypotheses& hypotheses, const std::string& effect) {
        const auto same = std::ranges::find_if(hypotheses.findings, [&](const std::optional<Finding>& one) {
            return one && one->effect == effect;
        });
        return **same;
    };
    CauseSet set(first, recording, {});
    set.causes = {{finding_of(first, "disturbance"), {}}, {finding_of(first, "lowpass"), {}}};
    for (int turn = 0; turn < 2; ++turn) {
        const std::optional<Finding> again = set.found_again(1);
        ASSERT_TRUE(again);
        set.causes[1].finding = *again;
    }
    const Finding& filter = set.causes[1].finding;
    EXPECT_NEAR(filter.entries.front().params.at("fc_hz"), 5.7, 3.0 * filter.sd.front().at("fc_hz"));
    const Hypotheses without = set.without(1);
    EXPECT_GT(finding_of(without, "lowpass").evidence_nats,
              finding_of(without, "noise_colour").evidence_nats);
}

TEST(Disturbance, IsLeftOutOfASecondRecordingToo) {
    const SensorModel model = calibrated_sensor();
    DiagnosisOptions options;
    options.simulations = 60;
    options.holdout = recorded(bumped(model), two_minutes, 4);
    const auto diagnosis = diagnose(recorded(bumped(model), two_minutes, 3), model, "model.json", options);
    ASSERT_TRUE(diagnosis);
    EXPECT_EQ(diagnosis->verdict, Verdict::known);
    ASSERT_EQ(diagnosis->causes.size(), 1U);
    EXPECT_EQ(diagnosis->causes.front().finding.effect, "disturbance");
    EXPECT_GT(diagnosis->causes.front().share.value, 0.9);
}

TEST(Disturbance, IsNoneWithoutBumps) {
    const SensorModel model = calibrated_sensor();
    int found_any = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto recording = recorded(model, two_minutes, seed);
        if (found(make_disturbance_estimator, "disturbance", recording, model)) { ++found_any; }
    }
    EXPECT_EQ(found_any, 0);
}

TEST(Disturbance, IsNotLookedForTwice) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(bumped(model), two_minutes, 3);
    EXPECT_TRUE(found(make_disturbance_estimator, "disturbance", recording, model));
    EXPECT_FALSE(found(make_disturbance_estimator, "disturbance", recording, bumped(model)));
}

}  // namespace
}  // namespace gyrolog
