#include "analysis/diagnose/diagnosis.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/cause_shares.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

std::set<std::string> effects_of(const Diagnosis& diagnosis) {
    std::set<std::string> effects;
    for (const Cause& cause : diagnosis.causes) { effects.insert(cause.finding.effect); }
    return effects;
}

SensorModel with_four_effects(SensorModel sensor) {
    sensor =
        with_effect(sensor, "tone", {{"amplitude_dps", 0.02}, {"f_hz", 17.3}, {"phase_rad", 1.0}}, {"x"});
    sensor = with_effect(sensor, "bias_step", {{"at_s", 131.0}, {"step_dps", 0.05}}, {"y"});
    sensor = with_effect(sensor, "heavy_tail", {{"nu", 5.0}}, {"z"});
    return with_effect(sensor, "arw_scale", {{"factor", 1.2}}, {"y"});
}

Diagnosis diagnosis_of(const SensorModel& sensor) {
    DiagnosisOptions options;
    options.simulations = 20;
    return *diagnose(recorded(sensor, 36000, 90), calibrated_sensor(), "model", options);
}

TEST(Diagnosis, CallsFourEffectsKnown) {
    const Diagnosis four = diagnosis_of(with_four_effects(calibrated_sensor()));
    EXPECT_EQ(four.verdict, Verdict::known);
    EXPECT_EQ(effects_of(four), (std::set<std::string>{"arw_scale", "bias_step", "heavy_tail", "tone"}));
}

// With five different effects any recording is explained.
TEST(Diagnosis, CallsFiveEffectsUnexplained) {
    const Diagnosis five =
        diagnosis_of(with_effect(with_four_effects(calibrated_sensor()), "variance_change",
                                 {{"at_s", 201.0}, {"factor", 1.5}, {"ramp_s", 0.0}}, {"x"}));
    EXPECT_EQ(effects_of(five),
              (std::set<std::string>{"arw_scale", "bias_step", "heavy_tail", "tone", "variance_change"}));
    EXPECT_EQ(five.verdict, Verdict::unexplained);
    EXPECT_EQ(five.shrink_lo, 0.0);
    EXPECT_TRUE(five.split_half.judged.empty());
    ASSERT_GT(five.shrink, 0.5);
    double shares = 0.0;
    for (const Cause& cause : five.causes) {
        EXPECT_GT(cause.shrink_alone, 0.0)
            << cause.finding.effect << " of " << cause.finding.gain_nats << " nats";
        shares += cause.shrink_alone;
    }
    EXPECT_NEAR(shares, five.shrink, 1e-9);
}

// A jump of the first recording is none of the second, in which a correction by it would be a gap.
TEST(Diagnosis, JudgesASecondRecordingWithoutTheEventsOfTheFirst) {
    const SensorModel model = calibrated_sensor();
    const SensorModel jumping = with_effect(model, "bias_step", {{"at_s", 60.0}, {"step_dps", 0.05}}, {"y"});
    DiagnosisOptions options;
    options.simulations = 20;
    Recording second = *recorded(model, 12000, 92);
    second.name = "second.csv";
    options.holdout = std::make_shared<const Recording>(std::move(second));
    const Diagnosis diagnosis = *diagnose(recorded(jumping, 12000, 91), model, "model", options);
    ASSERT_EQ(effects_of(diagnosis), std::set<std::string>{"bias_step"});
    ASSERT_EQ(diagnosis.held_out, "second.csv");
    EXPECT_DOUBLE_EQ(diagnosis.gap_after.value, diagnosis.gap_before.value);
    EXPECT_EQ(diagnosis.causes.front().shrink_alone, 0.0);
    EXPECT_EQ(
        std::ranges::count(diagnosis.warnings,
                           "bias_step happened in the first recording: the second is judged without it"),
        1);
}

TEST(Diagnosis, OfEventsKnowsThoseThatHappenOnce) {
    std::set<std::string> events;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect != nullptr && is_event(std::string(link.effect->name))) {
            events.insert(std::string(link.effect->name));
        }
    }
    EXPECT_EQ(events, (std::set<std::string>{"bias_step", "variance_change", "warmup"}));
}

// What a diagnosis does not look for may be in a model.
TEST(Diagnosis, IsGivenOfAModelWithEffectsThatNothingLooksFor) {
    SensorModel model = calibrated_sensor();
    std::set<std::string> listed;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature != nullptr) { continue; }
        std::map<std::string, double> params;
        for (const EffectParam& param : link.effect->params) {
            params[std::string(param.name)] = param.otherwise.value_or(
                param.plausible_from + 0.1 * (param.plausible_to - param.plausible_from));
        }
        listed.insert(std::string(link.effect->name));
        model = with_effect(model, std::string(link.effect->name), params);
    }
    EXPECT_EQ(listed, (std::set<std::string>{"angle_noise", "self_heating", "temp_scale",
                                             "vibration_rectification"}));
    DiagnosisOptions options;
    options.simulations = 12;
    const Diagnosis diagnosis = *diagnose(recorded(model, 4096, 93), model, "model", options);
    EXPECT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_EQ(diagnosis.corrected.effects.size(), listed.size());
}

}  // namespace
}  // namespace gyrolog
