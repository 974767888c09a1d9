#include "analysis/diagnose/diagnosis.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

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
}

}  // namespace
}  // namespace gyrolog
