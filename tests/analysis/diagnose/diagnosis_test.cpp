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

// With five different effects any recording is explained.
TEST(Diagnosis, CallsFiveEffectsUnexplainedAndFourKnown) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor =
        with_effect(model, "tone", {{"amplitude_dps", 0.02}, {"f_hz", 17.3}, {"phase_rad", 1.0}}, {"x"});
    sensor = with_effect(sensor, "bias_step", {{"at_s", 131.0}, {"step_dps", 0.05}}, {"y"});
    sensor = with_effect(sensor, "heavy_tail", {{"nu", 5.0}}, {"z"});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.2}}, {"y"});
    DiagnosisOptions options;
    options.simulations = 20;
    const Diagnosis four = *diagnose(recorded(sensor, 36000, 90), model, "model", options);
    EXPECT_EQ(four.verdict, Verdict::known);
    EXPECT_EQ(effects_of(four), (std::set<std::string>{"arw_scale", "bias_step", "heavy_tail", "tone"}));
    sensor =
        with_effect(sensor, "variance_change", {{"at_s", 201.0}, {"factor", 1.5}, {"ramp_s", 0.0}}, {"x"});
    const Diagnosis five = *diagnose(recorded(sensor, 36000, 90), model, "model", options);
    EXPECT_EQ(effects_of(five),
              (std::set<std::string>{"arw_scale", "bias_step", "heavy_tail", "tone", "variance_change"}));
    EXPECT_EQ(five.verdict, Verdict::unexplained);
    EXPECT_EQ(five.shrink_lo, 0.0);
    EXPECT_TRUE(five.halves.judged.empty());
}

}  // namespace
}  // namespace gyrolog
