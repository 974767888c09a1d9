#include "analysis/diagnose/accelerometer_diagnosis.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {
namespace {

Diagnosis with_cause_at(const char* effect, const Place& where) {
    Diagnosis diagnosis;
    Cause& cause = diagnosis.causes.emplace_back();
    cause.finding.effect = effect;
    cause.finding.where = where;
    return diagnosis;
}

Place at_frequency(double from_hz, double to_hz) {
    Place place;
    place.freq_hz = Span{from_hz, to_hz};
    return place;
}

std::size_t shared_between(const char* effect, const Place& one, const char* other_effect,
                           const Place& other) {
    return shared_causes(with_cause_at(effect, one), with_cause_at(other_effect, other)).size();
}

TEST(SharedCauses, AreLinesOfOneFrequency) {
    EXPECT_EQ(shared_between("tone", at_frequency(31.39, 31.41), "tone", at_frequency(31.40, 31.42)), 1U);
    EXPECT_EQ(shared_between("tone", at_frequency(31.39, 31.41), "tone", at_frequency(12.0, 12.1)), 0U);
    EXPECT_EQ(shared_between("tone", at_frequency(31.39, 31.41), "narrowband", at_frequency(31.39, 31.41)),
              0U);
}

// Two sensors have two noises: the same effect in the same band says nothing.
TEST(SharedCauses, AreNoNoiseOfOneKind) {
    EXPECT_EQ(shared_between("flicker_missing", at_frequency(0.001, 1.0), "flicker_missing",
                             at_frequency(0.001, 1.0)),
              0U);
}

TEST(SharedCauses, AreInstantsAndStructures) {
    Place early;
    early.time_s = Span{100.0, 101.0};
    Place late;
    late.time_s = Span{300.0, 300.0};
    EXPECT_EQ(shared_between("bias_step", early, "bias_step", early), 1U);
    EXPECT_EQ(shared_between("bias_step", early, "bias_step", late), 0U);
    EXPECT_EQ(shared_between("stale", {}, "stale", {}), 1U);
}

TEST(AccelerometerDiagnosis, IsInGAndWithoutWhatMotionShows) {
    SensorModel model = typical_mpu9250();
    model.accelerometer.emplace();
    Diagnosis as_gyro = with_cause_at("tone", at_frequency(31.3, 31.5));
    as_gyro.causes[0].finding.entries = {{"tone", {"x"}, {{"f_hz", 31.4}, {"amplitude_dps", 0.01}}, {}}};
    as_gyro.causes[0].finding.sd = {{{"amplitude_dps", 0.001}}};
    as_gyro.untestable = {{"scale_factor", "no reference"}, {"temp_linear", "no temperature"}};
    as_gyro.corrected = accelerometer_as_gyro(model);
    as_gyro.corrected.effects = as_gyro.causes[0].finding.entries;
    const Diagnosis answer = diagnosis_of_accelerometer(as_gyro, model);
    // 0.01 deg/s stand for 300 ug.
    EXPECT_NEAR(answer.causes[0].finding.entries[0].params.at("amplitude_g"), 300e-6, 1e-12);
    EXPECT_NEAR(answer.causes[0].finding.sd[0].at("amplitude_g"), 30e-6, 1e-12);
    ASSERT_EQ(answer.untestable.size(), 1U);
    EXPECT_EQ(answer.untestable[0].effect, "temp_linear");
    ASSERT_EQ(answer.corrected.accelerometer->effects.size(), 1U);
    EXPECT_TRUE(answer.corrected.effects.empty());
}

TEST(AccelerometerDiagnosis, InKnownPosesSpeaksOfForces) {
    SensorModel model = typical_mpu9250();
    model.accelerometer.emplace();
    Place where;
    where.rate_rad_s = Span{0.0, standard_gravity_m_s2 * accelerometer_rad_s_per_m_s2};
    Diagnosis as_gyro = with_cause_at("misalignment", where);
    const std::string_view plateaus = find_effect("misalignment")->signature->decided_by;
    as_gyro.causes[0].decided_by = plateaus;
    as_gyro.next_recordings = {"to tell misalignment from scale_factor: " + std::string(plateaus)};
    as_gyro.untestable = {{"latency", "constant"}, {"g_sensitivity", "no specific force"}};
    as_gyro.domains.emplace_back();
    as_gyro.domains[0].name = "rate about x";
    as_gyro.domains[0].x_name = "reference rate (deg/s)";
    as_gyro.domains[0].x = {standard_gravity_m_s2 * accelerometer_rad_s_per_m_s2 * deg_per_rad};
    as_gyro.corrected = accelerometer_as_gyro(model, Exposure::known);
    const Diagnosis answer = diagnosis_of_accelerometer(as_gyro, model, Exposure::known);
    const Finding& finding = answer.causes[0].finding;
    EXPECT_EQ(finding.sensor, SensorKind::accelerometer);
    EXPECT_FALSE(finding.where.rate_rad_s);
    EXPECT_NEAR(finding.where.force_m_s2->to, standard_gravity_m_s2, 1e-12);
    EXPECT_TRUE(answer.causes[0].decided_by.starts_with("rests with each axis upward"));
    EXPECT_TRUE(answer.next_recordings[0].starts_with("to tell misalignment from scale_factor: rests with"));
    ASSERT_EQ(answer.untestable.size(), 1U);
    EXPECT_EQ(answer.untestable[0].effect, "latency");
    EXPECT_EQ(answer.domains[0].name, "force along x");
    EXPECT_EQ(answer.domains[0].x_name, "known force (g)");
    EXPECT_NEAR(answer.domains[0].x[0], 1.0, 1e-12);
}

}  // namespace
}  // namespace gyrolog
