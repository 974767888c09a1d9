#include "analysis/diagnose/multiscale/long_diagnosis.hpp"

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

constexpr std::size_t samples_per_row = 20;
constexpr std::size_t samples_of_all = 400'000;
constexpr std::size_t samples_of_beginning = 50'000;

SensorModel fast_sensor() {
    SensorModel model = calibrated_sensor();
    model.rate_hz = 1000.0;
    return model;
}

LongRecording long_recording(const SensorModel& sensor, std::uint64_t seed) {
    const auto whole = recorded(sensor, samples_of_all, seed);
    return {std::make_shared<const Recording>(first_rows(*whole, samples_of_beginning)),
            std::make_shared<const Recording>(means_of(*whole, samples_per_row))};
}

Diagnosis diagnosis_of(const SensorModel& sensor, std::uint64_t seed,
                       const SensorModel& model = fast_sensor(), std::uint64_t draws = 1) {
    DiagnosisOptions options;
    options.simulations = 20;
    options.seed = draws;
    return *diagnose_long(long_recording(sensor, seed), model, "model", options);
}

std::vector<std::string> effects_of(const Diagnosis& diagnosis) {
    std::vector<std::string> effects;
    for (const Cause& cause : diagnosis.causes) { effects.push_back(cause.finding.effect); }
    return effects;
}

double param(const Diagnosis& diagnosis, const char* effect, const char* name) {
    for (const Cause& cause : diagnosis.causes) {
        if (cause.finding.effect == effect) { return cause.finding.entries.front().params.at(name); }
    }
    ADD_FAILURE() << "no " << effect;
    return 0.0;
}

TEST(LongDiagnosis, FindsNothingWhereNothingIs) {
    // Of the model's line, 137 Hz, means of 50 Hz have the image at 13 Hz.
    const SensorModel sensor = with_effect(
        fast_sensor(), "tone", {{"amplitude_dps", 0.05}, {"f_hz", 137.0}, {"phase_rad", 1.0}}, {"y"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 40, sensor);
    EXPECT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_GT(diagnosis.p_none, 0.01);
    EXPECT_THAT(diagnosis.causes, IsEmpty());
    EXPECT_EQ(diagnosis.samples, samples_of_all);
    EXPECT_NEAR(diagnosis.duration_s, 400.0, 0.1);
    EXPECT_NEAR(diagnosis.rate_hz, 1000.0, 0.1);
    ASSERT_THAT(diagnosis.passes, SizeIs(2));
    EXPECT_EQ(diagnosis.passes[0].rows, samples_of_beginning);
    EXPECT_EQ(diagnosis.passes[1].samples_per_row, samples_per_row);
}

// A line has an image in means, and more white noise is more of it there: each is one cause, as the samples
// tell it. What is slow the beginning cannot tell.
TEST(LongDiagnosis, FindsTheFastInTheBeginningAndTheSlowInTheMeans) {
    SensorModel sensor = with_effect(fast_sensor(), "tone",
                                     {{"amplitude_dps", 0.05}, {"f_hz", 137.0}, {"phase_rad", 1.0}}, {"y"});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.2}}, {"z"});
    sensor = with_effect(sensor, "gauss_markov", {{"sigma_dps", 0.008}, {"tau_s", 20.0}}, {"x"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 41);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    EXPECT_THAT(effects_of(diagnosis), UnorderedElementsAre("tone", "arw_scale", "gauss_markov"));
    EXPECT_NEAR(param(diagnosis, "tone", "f_hz"), 137.0, 0.01);
    EXPECT_NEAR(param(diagnosis, "tone", "amplitude_dps"), 0.05, 0.005);
    EXPECT_NEAR(param(diagnosis, "arw_scale", "factor"), 1.2, 0.02);
    EXPECT_NEAR(param(diagnosis, "gauss_markov", "sigma_dps"), 0.008, 0.004);
    // The samples' noise and converter, not the means'.
    EXPECT_EQ(diagnosis.corrected.effects.size(), 3U);
    EXPECT_EQ(diagnosis.corrected.lsb_rad_s, fast_sensor().lsb_rad_s);
    EXPECT_NEAR(diagnosis.corrected.axes[1].noise.N_rad_per_sqrt_s,
                fast_sensor().axes[1].noise.N_rad_per_sqrt_s, 1e-12);
    for (const Cause& cause : diagnosis.causes) { EXPECT_GT(cause.share.value, 0.0); }
    EXPECT_GT(diagnosis.shrink.value, 0.9);
    EXPECT_LT(diagnosis.gap_named.value, 0.5 * diagnosis.gap_before.value);
}

// In means each is some three standard deviations.
TEST(LongDiagnosis, TakesWhatSpikesLeaveInMeansForNoNoise) {
    const SensorModel sensor = with_effect(
        fast_sensor(), "spikes", {{"per_hour", 1800.0}, {"smallest_dps", 1.5}, {"largest_dps", 3.0}}, {"z"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 48);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    EXPECT_THAT(effects_of(diagnosis), ElementsAre("spikes"));
    EXPECT_EQ(diagnosis.passes[1].verdict, Verdict::none);
}

// In means some twelve to forty standard deviations, where they would be a gap that nothing explains.
TEST(LongDiagnosis, HasStrongSpikesInItsMeansToo) {
    const SensorModel sensor = with_effect(
        fast_sensor(), "spikes", {{"per_hour", 900.0}, {"smallest_dps", 6.0}, {"largest_dps", 20.0}}, {"z"});
    // Which pass tells more of their size is close, and the draws decide: the model of the means has those of
    // the beginning, or they are found in the means.
    int in_model_of_means = 0;
    for (const std::uint64_t draws : {1U, 3U}) {
        const Diagnosis diagnosis = diagnosis_of(sensor, 50, fast_sensor(), draws);
        EXPECT_EQ(diagnosis.verdict, Verdict::known) << draws;
        EXPECT_THAT(effects_of(diagnosis), ElementsAre("spikes")) << draws;
        EXPECT_NE(diagnosis.passes[1].verdict, Verdict::unexplained) << draws;
        in_model_of_means += diagnosis.passes[1].verdict == Verdict::none ? 1 : 0;
    }
    EXPECT_GT(in_model_of_means, 0);
    // The model has them.
    EXPECT_EQ(diagnosis_of(sensor, 51, sensor).verdict, Verdict::none);
}

// Of so few the beginning has one or none.
TEST(LongDiagnosis, SeesRareSpikesInMeansAtTheirSize) {
    const SensorModel sensor = with_effect(
        fast_sensor(), "spikes", {{"per_hour", 60.0}, {"smallest_dps", 10.0}, {"largest_dps", 20.0}}, {"z"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 52);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    EXPECT_THAT(effects_of(diagnosis), ElementsAre("spikes"));
    EXPECT_NEAR(param(diagnosis, "spikes", "per_hour"), 60.0, 45.0);
    EXPECT_NEAR(param(diagnosis, "spikes", "smallest_dps"), 10.0, 4.0);
    EXPECT_NEAR(param(diagnosis, "spikes", "largest_dps"), 20.0, 4.0);
    ASSERT_THAT(diagnosis.corrected.effects, SizeIs(1));
}

// A mean of heavy tails has some of them left: no single samples.
TEST(LongDiagnosis, TakesWhatHeavyTailsLeaveInMeansForNoSpikes) {
    const SensorModel sensor = with_effect(fast_sensor(), "heavy_tail", {{"nu", 3.0}}, {"y"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 53);
    EXPECT_THAT(effects_of(diagnosis), ElementsAre("heavy_tail"));
    EXPECT_EQ(diagnosis.passes[1].verdict, Verdict::none);
    EXPECT_EQ(diagnosis_of(sensor, 54, sensor).verdict, Verdict::none);
}

TEST(LongDiagnosis, SeesWhatComesAfterTheBeginning) {
    const SensorModel sensor =
        with_effect(fast_sensor(), "bias_step", {{"at_s", 233.0}, {"step_dps", 0.03}}, {"x"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 45);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    EXPECT_THAT(effects_of(diagnosis), ElementsAre("bias_step"));
    EXPECT_NEAR(param(diagnosis, "bias_step", "at_s"), 233.0, 1.0);
    EXPECT_EQ(diagnosis.passes[0].verdict, Verdict::none);
    EXPECT_EQ(diagnosis.passes[1].verdict, Verdict::known);
}

// A line in the means is no white noise, whether or not the model has it.
TEST(LongDiagnosis, SeesASlowLineForWhatItIs) {
    const SensorModel sensor = with_effect(
        fast_sensor(), "tone", {{"amplitude_dps", 0.06}, {"f_hz", 2.3}, {"phase_rad", 1.0}}, {"y"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 46);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    EXPECT_THAT(effects_of(diagnosis), ElementsAre("tone"));
    EXPECT_NEAR(param(diagnosis, "tone", "amplitude_dps"), 0.06, 0.002);
    EXPECT_NEAR(param(diagnosis, "tone", "phase_rad"), 1.0, 0.1);
    EXPECT_EQ(diagnosis_of(sensor, 47, sensor).verdict, Verdict::none);
}

TEST(LongDiagnosis, KeepsAFastLineAndASlowOneOfOneAxisApart) {
    SensorModel sensor = with_effect(fast_sensor(), "tone",
                                     {{"amplitude_dps", 0.06}, {"f_hz", 2.3}, {"phase_rad", 1.0}}, {"y"});
    sensor =
        with_effect(sensor, "tone", {{"amplitude_dps", 0.06}, {"f_hz", 137.0}, {"phase_rad", 0.0}}, {"y"});
    const Diagnosis diagnosis = diagnosis_of(sensor, 49);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    std::vector<double> f_hz;
    for (const Cause& cause : diagnosis.causes) {
        f_hz.push_back(cause.finding.entries.front().params.at("f_hz"));
    }
    EXPECT_THAT(f_hz, UnorderedElementsAre(testing::DoubleNear(2.3, 0.01), testing::DoubleNear(137.0, 0.01)));
}

}  // namespace
}  // namespace gyrolog
