#include "analysis/calibrate/temperature_fit.hpp"

#include <gtest/gtest.h>

#include "analysis/calibrate/calibration.hpp"
#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {
namespace {

Calibration warmed(const FaultySensor& sensor, double from_C, double to_C, std::uint64_t seed = 21) {
    MovedSensor moved(sensor, seed, 20.0);
    moved.set_temperature_C(from_C);
    moved.warm(400.0, to_C);
    return calibrate({moved.recording("ramp.csv", true)});
}

FaultySensor cubic() {
    FaultySensor sensor;
    sensor.gyro_c = {2e-4, -4e-6, 2e-7};
    sensor.acc_c = {3e-3, 5e-5, -2e-6};
    return sensor;
}

TEST(TemperatureFit, ARampTellsACubic) {
    const Calibration calibration = warmed(cubic(), 5.0, 45.0);
    ASSERT_TRUE(calibration.gyro_temperature.calibration);
    ASSERT_TRUE(calibration.accelerometer_temperature.calibration);
    const TemperatureCalibration& gyro = *calibration.gyro_temperature.calibration;
    EXPECT_NEAR(gyro.reference_C, 25.0, 0.5);
    EXPECT_EQ(gyro.axes[0].order, 3U);
    EXPECT_EQ(gyro.axes[2].order, 0U) << "z does not follow";
    const TemperatureCalibration& force = *calibration.accelerometer_temperature.calibration;
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(gyro.axes[0].c[k], cubic().gyro_c[k], 4.0 * gyro.axes[0].c_sd[k]) << k;
        EXPECT_NEAR(force.axes[0].c[k], cubic().acc_c[k], 4.0 * force.axes[0].c_sd[k]) << k;
    }
    // 0.001 rad/s a sample, 20 samples a block of a second, at most 300 blocks of 400 s.
    EXPECT_NEAR(gyro.axes[0].residual_sd, 0.001 / std::sqrt(20.0 * 4.0 / 3.0), 2e-5);
}

TEST(TemperatureFit, TheOrderIsWhatTheDataSupport) {
    FaultySensor line;
    line.gyro_c = {2e-4, 0.0, 0.0};
    const Calibration calibration = warmed(line, 5.0, 45.0);
    ASSERT_TRUE(calibration.gyro_temperature.calibration);
    const TemperaturePolynomial& x = calibration.gyro_temperature.calibration->axes[0];
    EXPECT_EQ(x.order, 1U);
    EXPECT_LT(x.F[2], x.F_needed[2]);
    EXPECT_LT(x.F[1], x.F_needed[1]);
    EXPECT_GT(x.F[0], x.F_needed[0]);
    // F(1, many) at 1 %: 6.63.
    EXPECT_NEAR(x.F_needed[0], 6.7, 0.2);
}

// A thermometer that is read seldom, or two files in one: what lies between the two temperatures never was.
TEST(TemperatureFit, AJumpOfTheTemperatureMakesNoCubic) {
    FaultySensor line;
    line.gyro_c = {2e-4, 0.0, 0.0};
    MovedSensor moved(line, 22, 20.0);
    moved.set_temperature_C(20.0);
    moved.rest(200.0);
    moved.set_temperature_C(70.0);
    moved.rest(200.0);
    const Calibration calibration = calibrate({moved.recording("jump.csv", true)});
    ASSERT_TRUE(calibration.gyro_temperature.calibration);
    const TemperaturePolynomial& x = calibration.gyro_temperature.calibration->axes[0];
    EXPECT_EQ(x.order, 1U);
    EXPECT_NEAR(x.c[0], line.gyro_c[0], 4.0 * x.c_sd[0]);
}

TEST(TemperatureFit, ASmallRangeTellsNothing) {
    const Calibration calibration = warmed(cubic(), 24.0, 27.0);
    EXPECT_FALSE(calibration.gyro_temperature.calibration);
    EXPECT_NEAR(calibration.gyro_temperature.range_C, 3.0, 0.1);
}

TEST(TemperatureFit, ARangeOfSevenDegreesTellsALineAtMost) {
    const Calibration calibration = warmed(cubic(), 22.0, 29.0);
    ASSERT_TRUE(calibration.gyro_temperature.calibration);
    EXPECT_LE(calibration.gyro_temperature.calibration->axes[0].order, 1U);
}

// A tilt on the way is another pose: its step is no temperature's.
TEST(TemperatureFit, AnotherPoseHasAnotherConstant) {
    FaultySensor sensor;
    sensor.acc_c = {3e-3, 5e-5, 0.0};
    MovedSensor moved(sensor, 22, 20.0);
    moved.set_temperature_C(5.0);
    moved.warm(200.0, 25.0);
    moved.tilt_to({1, 0, 1});
    moved.warm(200.0, 45.0);
    const Calibration calibration = calibrate({moved.recording("ramp.csv", true)});
    ASSERT_TRUE(calibration.accelerometer_temperature.calibration);
    const TemperaturePolynomial& x = calibration.accelerometer_temperature.calibration->axes[0];
    EXPECT_EQ(x.order, 2U);
    for (std::size_t k = 0; k < x.order; ++k) { EXPECT_NEAR(x.c[k], sensor.acc_c[k], 4.0 * x.c_sd[k]) << k; }
}

TEST(TemperatureFit, BeyondItsRangeThePolynomialIsThatOfTheEnd) {
    TemperatureCalibration calibration;
    calibration.reference_C = 25.0;
    calibration.from_C = 10.0;
    calibration.to_C = 40.0;
    calibration.axes[0].c = {1.0, 0.5, 0.25};
    EXPECT_DOUBLE_EQ(calibration.offset(27.0)[0], 2.0 + 2.0 + 2.0);
    EXPECT_DOUBLE_EQ(calibration.offset(50.0)[0], calibration.offset(40.0)[0]);
    EXPECT_DOUBLE_EQ(calibration.offset(0.0)[0], calibration.offset(10.0)[0]);
}

}  // namespace
}  // namespace gyrolog
