#include "analysis/simulate/accelerometer_as_gyro.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/accelerometer_effect.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {
namespace {

constexpr double g = standard_gravity_m_s2;

SensorModel six_axes() {
    SensorModel model = typical_mpu9250();
    AccelerometerModel& accelerometer = model.accelerometer.emplace();
    for (AxisModel& axis : accelerometer.axes) {
        axis.noise = {1e-4, 2e-3, 3e-4, 4e-5, 5e-6};
        axis.bias_rad_s = 0.1;
    }
    accelerometer.M[0][1] = 0.02;
    accelerometer.lsb_m_s2 = g / 16384.0;
    accelerometer.full_scale_m_s2 = accelerometer.saturation_m_s2 = 2.0 * g;
    accelerometer.effects = {
        {"tone", {"x"}, {{"f_hz", 12.0}, {"amplitude_g", 2e-3}, {"phase_rad", 0.0}}, {}},
        {"temperature_table", {"y"}, {}, {}, {{"temp_C", {20.0, 30.0}}, {"bias_g", {0.0, 1e-3}}}}};
    return model;
}

// An MPU-9250's 300 ug/sqrt(Hz) become its gyro's 0.01 dps/sqrt(Hz).
TEST(AccelerometerAsGyro, GivesDataSheetsNoiseTheGyrosSize) {
    SensorModel model = six_axes();
    model.accelerometer->axes[0].noise.N_rad_per_sqrt_s = 300e-6 * g;
    EXPECT_NEAR(accelerometer_as_gyro(model).axes[0].noise.N_rad_per_sqrt_s * deg_per_rad, 0.01, 1e-12);
    EXPECT_NEAR(0.01 * rad_per_deg * unit_of_accelerometer_as_gyro().per_column_unit, 300e-6, 1e-15);
}

TEST(AccelerometerAsGyro, AModelComesBackAsItWas) {
    const SensorModel model = six_axes();
    const SensorModel back = with_accelerometer_of(model, accelerometer_as_gyro(model));
    const AccelerometerModel& before = *model.accelerometer;
    const AccelerometerModel& after = *back.accelerometer;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double f_hz : {1e-3, 1.0, 40.0}) {
            EXPECT_NEAR(after.axes[axis].noise.psd(f_hz) / before.axes[axis].noise.psd(f_hz), 1.0, 1e-12);
        }
        EXPECT_EQ(after.axes[axis].bias_rad_s, before.axes[axis].bias_rad_s);
        EXPECT_EQ(after.M[axis], before.M[axis]);
    }
    EXPECT_NEAR(after.lsb_m_s2 / before.lsb_m_s2, 1.0, 1e-12);
    EXPECT_NEAR(after.saturation_m_s2 / before.saturation_m_s2, 1.0, 1e-12);
    ASSERT_EQ(after.effects.size(), before.effects.size());
    EXPECT_NEAR(after.effects[0].params.at("amplitude_g"), 2e-3, 1e-15);
    EXPECT_EQ(after.effects[0].params.at("f_hz"), 12.0);
    EXPECT_NEAR(after.effects[1].table.at("bias_g")[1], 1e-3, 1e-15);
    EXPECT_EQ(after.effects[1].table.at("temp_C")[1], 30.0);
    EXPECT_FALSE(simulation_refusal(model));
}

TEST(AccelerometerAsGyro, ARangeThatNothingReachesStaysOne) {
    SensorModel model = six_axes();
    model.accelerometer->full_scale_m_s2 = model.accelerometer->saturation_m_s2 = no_range_m_s2;
    const SensorModel as_gyro = accelerometer_as_gyro(model);
    EXPECT_EQ(as_gyro.saturation_rad_s, no_range_rad_s);
    EXPECT_EQ(with_accelerometer_of(model, as_gyro).accelerometer->full_scale_m_s2, no_range_m_s2);
}

TEST(AccelerometerAsGyro, ARecordingKeepsEverySampleAndTheTemperature) {
    SimulationRequest request;
    request.samples = 500;
    const Recording whole = simulate_recording(six_axes(), request);
    const std::optional<Recording> seen = accelerometer_as_gyro(whole);
    ASSERT_TRUE(seen);
    ASSERT_EQ(seen->rows(), whole.rows());
    EXPECT_EQ(seen->columns.front().name, "gx");
    const Column& force = *whole.find("az");
    const Column& rate = *seen->find("gz");
    EXPECT_EQ(rate.is_counts(), force.is_counts());
    for (std::size_t i = 0; i < force.size(); ++i) {
        EXPECT_NEAR(rate.value(i), force.value(i) * accelerometer_rad_s_per_m_s2, 1e-12);
    }
    EXPECT_EQ(seen->find("ref_x"), nullptr);
    EXPECT_EQ(seen->find("temp") != nullptr, whole.find("temp") != nullptr);
    Recording without = whole;
    std::erase_if(without.columns, [](const Column& column) { return column.name[0] == 'a'; });
    EXPECT_FALSE(accelerometer_as_gyro(without));
}

TEST(AccelerometerAsGyro, RowsWithoutAValueAreMissing) {
    SimulationRequest request;
    request.samples = 500;
    Recording whole = simulate_recording(six_axes(), request);
    for (Column& column : whole.columns) {
        if (column.name != "ay") { continue; }
        std::vector<double> values = column.values();
        values[100] = std::nan("");
        column.data = values;
        column.scale = 1.0;
        column.offset = 0.0;
    }
    const std::optional<Recording> seen = accelerometer_as_gyro(whole);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->rows(), 499U);
    EXPECT_EQ(seen->segments.size(), 2U);
    ASSERT_FALSE(seen->warnings.empty());
}

TEST(AccelerometerAsGyro, ForcesThatARecordingTellsAreItsReference) {
    SimulationRequest request;
    request.samples = 100;
    Recording whole = simulate_recording(six_axes(), request);
    EXPECT_EQ(exposure_of(*accelerometer_as_gyro(whole)), Exposure::upright);
    whole.columns.push_back({"ref_ay", "m/s^2", std::vector<double>(whole.rows(), -3.0)});
    whole.columns.push_back({"ref_x", "rad/s", std::vector<double>(whole.rows(), 1.0)});
    const Recording seen = *accelerometer_as_gyro(whole);
    EXPECT_EQ(exposure_of(seen), Exposure::known);
    EXPECT_EQ(seen.find("ref_x"), nullptr);
    ASSERT_NE(seen.find("ref_y"), nullptr);
    EXPECT_EQ(seen.find("ref_y")->unit, "rad/s");
    EXPECT_NEAR(seen.find("ref_y")->value(7), -3.0 * accelerometer_rad_s_per_m_s2, 1e-12);
}

// What is known of the forces tells bias and gravity apart, and needs the matrix.
TEST(AccelerometerAsGyro, OfKnownForcesHasItsMatrixAndNoGravityInItsBias) {
    SensorModel model = six_axes();
    model.accelerometer->sd_abs = {{"M", 1e-3}};
    SensorModel as_gyro = accelerometer_as_gyro(model, Exposure::known);
    EXPECT_EQ(as_gyro.M, model.accelerometer->M);
    EXPECT_EQ(as_gyro.sd_abs.at("M"), 1e-3);
    EXPECT_NEAR(as_gyro.axes[2].bias_rad_s, 0.1 * accelerometer_rad_s_per_m_s2, 1e-12);
    EXPECT_FALSE(accelerometer_as_gyro(model).sd_abs.contains("M"));
    as_gyro.axes[2].bias_rad_s = 0.3 * accelerometer_rad_s_per_m_s2;
    EXPECT_NEAR(with_accelerometer_of(model, as_gyro, Exposure::known).accelerometer->axes[2].bias_rad_s, 0.3,
                1e-12);
    EXPECT_EQ(with_accelerometer_of(model, as_gyro).accelerometer->axes[2].bias_rad_s, 0.1);
}

TEST(AccelerometerEffect, NamesAreThoseOfTheOtherSensor) {
    EXPECT_EQ(accelerometer_param_name("c1_dps_per_C"), "c1_g_per_C");
    EXPECT_EQ(accelerometer_param_name("K_dps_sqrt_hz"), "K_g_sqrt_hz");
    EXPECT_EQ(accelerometer_param_name("f_hz"), "");
}

}  // namespace
}  // namespace gyrolog
