#include "analysis/simulate/fitted_model.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {
namespace {

Recording white_recording(std::size_t samples, double sd_rad_s, double bias_rad_s) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(bias_rad_s, sd_rad_s);
    std::vector<double> x(samples);
    for (double& value : x) { value = normal(random); }
    Recording recording;
    recording.rate_hz = 100.0;
    recording.segments = {{0, samples, 0}};
    recording.columns.push_back({"gx", "rad/s", x, 1.0, 0.0, "rad_s"});
    return recording;
}

TEST(FittedModel, OfRealNumbersCanBeSimulatedInTheSmallestRangeThatHoldsThem) {
    const Recording recording = white_recording(20'000, 0.01, 300.0 * rad_per_deg);
    const SensorModel model = fitted_model(analyze(recording), recording);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    EXPECT_NEAR(model.full_scale_rad_s, 500.0 * rad_per_deg, 1e-9);
    EXPECT_EQ(model.lsb_rad_s, 0.0);
    EXPECT_NEAR(model.axes[0].noise.N_rad_per_sqrt_s, 0.001, 5e-5);
}

TEST(FittedModel, HasTheAccelerometerBesideTheGyro) {
    Recording recording = white_recording(20'000, 0.01, 0.0);
    std::mt19937_64 random(9);
    std::normal_distribution<double> normal;
    constexpr double step_m_s2 = 2.0 * standard_gravity_m_s2 / 32768.0;
    for (const char* name : {"ax", "ay", "az"}) {
        const double mean_m_s2 = name[1] == 'z' ? standard_gravity_m_s2 : 0.0;
        std::vector<std::int16_t> counts(20'000);
        for (std::int16_t& count : counts) {
            count = static_cast<std::int16_t>(std::lround((mean_m_s2 + 0.03 * normal(random)) / step_m_s2));
        }
        recording.columns.push_back({name, "m/s^2", counts, step_m_s2, 0.0, ""});
    }
    const SensorModel model = fitted_model(analyze(recording), recording);
    ASSERT_TRUE(model.accelerometer);
    EXPECT_NEAR(model.accelerometer->axes[1].noise.N_rad_per_sqrt_s, 0.003, 4.0 * 0.003 / std::sqrt(4e4));
    EXPECT_EQ(model.accelerometer->axes[2].bias_rad_s, 0.0);
    EXPECT_EQ(model.accelerometer->lsb_m_s2, step_m_s2);
    EXPECT_NEAR(model.accelerometer->full_scale_m_s2, 2.0 * standard_gravity_m_s2, 1e-9);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    EXPECT_NEAR(model.axes[0].noise.N_rad_per_sqrt_s, 0.001, 5e-5);
}

TEST(FittedModel, HasTheStepOfTheConverterOnceAndNotInTheNoise) {
    constexpr double step_rad_s = 0.015;
    Recording recording = white_recording(100'000, 0.01, 0.1);
    for (double& x : std::get<std::vector<double>>(recording.columns[0].data)) {
        x = std::round(x / step_rad_s) * step_rad_s;
    }
    const SensorModel model = fitted_model(analyze(recording), recording);
    EXPECT_NEAR(model.lsb_rad_s, step_rad_s, 1e-9);
    EXPECT_NEAR(model.full_scale_rad_s, 32768.0 * step_rad_s, 1e-6);
    // Of samples 0.01 scattered; the step alone would add 9 %.
    EXPECT_NEAR(model.axes[0].noise.N_rad_per_sqrt_s, 0.001, 1e-5);
}

TEST(FittedModel, PlaysBackALineThatTheRecordHas) {
    Recording recording = white_recording(50'000, 0.01, 0.0);
    auto& x = std::get<std::vector<double>>(recording.columns[0].data);
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] += 0.02 * std::sin(2.0 * pi * 12.5 * static_cast<double>(i) / 100.0);
    }
    const SensorModel model = fitted_model(analyze(recording), recording);
    ASSERT_EQ(model.effects.size(), 1U);
    EXPECT_EQ(model.effects[0].effect, "tone");
    EXPECT_NEAR(model.effects[0].params.at("f_hz"), 12.5, 1e-3);
    EXPECT_NEAR(model.effects[0].params.at("amplitude_dps"), 0.02 * deg_per_rad, 0.02);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
}

TEST(FittedModel, HasTheScatterOfTheStampsAndOfTheThermometer) {
    Recording recording = white_recording(20'000, 0.01, 0.0);
    recording.stamps = StampKind::sampling;
    recording.stamp_jitter_s = 3e-5;
    recording.rate_sd_hz = 1e-9;
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(0.0, 0.03);
    std::vector<double> temp(20'000);
    for (std::size_t i = 0; i < temp.size(); ++i) {
        temp[i] = 25.0 + 1e-3 * static_cast<double>(i) + normal(random);
    }
    recording.columns.push_back({"temp", "degC", temp, 1.0, 0.0, "C"});
    const SensorModel model = fitted_model(analyze(recording), recording);
    EXPECT_EQ(model.timestamp_jitter_s, 3e-5);
    EXPECT_NEAR(model.temp_noise_C, 0.03, 0.03 * 4.0 * std::sqrt(1.5 / 20'000.0));
    EXPECT_NEAR(model.sd_abs.at("rate_rel"), 5e-5, 1e-9);
    recording.stamps = StampKind::arrival;
    EXPECT_EQ(fitted_model(analyze(recording), recording).timestamp_jitter_s, 0.0);
}

TEST(FittedModel, HasTheDriftThatWasTakenOffAndItsTemperature) {
    constexpr std::size_t samples = 20'000;
    Recording recording = white_recording(samples, 0.01, 0.1);
    std::vector<double> temp(samples);
    auto& x = std::get<std::vector<double>>(recording.columns[0].data);
    for (std::size_t i = 0; i < samples; ++i) {
        temp[i] = 35.0 + 5.0 * std::sin(9.0 * static_cast<double>(i) / samples);
        x[i] += 0.01 * temp[i];
    }
    recording.columns.push_back({"temp", "degC", temp, 1.0, 0.0, "C"});
    const SensorModel model = fitted_model(analyze(recording), recording);
    ASSERT_EQ(model.effects.size(), 1U);
    EXPECT_EQ(model.effects[0].effect, "temp_linear");
    EXPECT_EQ(model.effects[0].axes, std::vector<std::string>{"x"});
    EXPECT_NEAR(model.effects[0].params.at("c1_dps_per_C"), 0.01 * deg_per_rad, 0.01);
    const double mean_C = model.effects[0].params.at("reference_C");
    EXPECT_NEAR(mean_C, 36.06, 0.1);  // 35 + 5 (1 - cos 9) / 9
    ASSERT_TRUE(model.temperature);
    EXPECT_EQ(model.temperature->reference_C, mean_C);
    EXPECT_NEAR(model.axes[0].bias_rad_s, 0.1 + 0.01 * mean_C, 1e-3);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    AnalysisOptions keep;
    keep.keep_temperature = true;
    const SensorModel kept = fitted_model(analyze(recording, keep), recording);
    EXPECT_FALSE(kept.temperature);
    for (const EffectModel& effect : kept.effects) { EXPECT_NE(effect.effect, "temp_linear"); }
}

}  // namespace
}  // namespace gyrolog
