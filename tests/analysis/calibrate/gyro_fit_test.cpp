#include "analysis/calibrate/gyro_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/calibrate/calibration.hpp"
#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

CalibrationOptions with_turns() {
    CalibrationOptions options;
    options.observations.turn_rad = 2.0 * std::numbers::pi;
    options.observations.turn_sd_rad = 1e-3;
    return options;
}

void expect_truth(const GyroCalibration& fitted, const FaultySensor& truth) {
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(fitted.bias_rad_s[i], truth.gyro_bias_rad_s[i], 4.0 * fitted.bias_sd_rad_s[i]) << i;
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(fitted.M[i][j], truth.gyro_M[i][j], 4.0 * fitted.M_sd[i][j]) << i << j;
            EXPECT_LT(fitted.M_sd[i][j], 0.005) << i << j;
            EXPECT_NEAR(fitted.K_s_per_m[i][j], truth.K_s_per_m[i][j], 4.0 * fitted.K_sd_s_per_m[i][j])
                << i << j;
        }
    }
}

TEST(GyroFit, TurnsAndMovesTellAllParameters) {
    const FaultySensor truth;
    MovedSensor moved(truth, 11);
    whole_session(moved);
    const Calibration calibration = calibrate({moved.recording()}, with_turns());
    EXPECT_EQ(calibration.turns, 3U);
    ASSERT_TRUE(calibration.gyro.calibration);
    EXPECT_TRUE(calibration.gyro.undetermined.empty());
    EXPECT_TRUE(calibration.gyro.calibration->has_g_sensitivity);
    expect_truth(*calibration.gyro.calibration, truth);
}

// Gravity alone, no angle told.
TEST(GyroFit, MovesBetweenPosesTellTheScaleWithoutAnyAngle) {
    const FaultySensor truth;
    MovedSensor moved(truth, 12);
    whole_session(moved);
    const Calibration calibration = calibrate({moved.recording()});
    EXPECT_EQ(calibration.turns, 0U);
    EXPECT_GE(calibration.moves, 12U);
    ASSERT_TRUE(calibration.gyro.calibration);
    EXPECT_TRUE(calibration.gyro.undetermined.empty());
    expect_truth(*calibration.gyro.calibration, truth);
}

// A turn in four parts with rests between them is one turn.
TEST(GyroFit, QuartersMakeUpATurn) {
    MovedSensor moved({}, 13);
    whole_session(moved);
    moved.place({0, 0, 1});
    for (int quarter = 0; quarter < 4; ++quarter) {
        moved.turn({0, 0, 1}, std::numbers::pi / 2.0);
        moved.rest(2.0);
    }
    EXPECT_EQ(calibrate({moved.recording()}, with_turns()).turns, 4U);
}

TEST(GyroFit, ATurnOfAnotherSizeIsNotUsedAndSaid) {
    MovedSensor moved({}, 14);
    whole_session(moved);
    moved.turn({0, 0, 1}, 3.6);
    moved.rest(2.0);
    const Calibration calibration = calibrate({moved.recording()}, with_turns());
    EXPECT_EQ(calibration.turns, 3U);
    EXPECT_THAT(calibration.warnings, Contains(HasSubstr("is no multiple of --turn 360 deg")));
}

TEST(GyroFit, OneAxisTellsOneColumn) {
    MovedSensor moved({}, 15);
    moved.rest(3.0);
    moved.turn({0, 0, 1}, 2.0 * std::numbers::pi, 3.0);
    moved.rest(3.0);
    const Calibration calibration = calibrate({moved.recording()}, with_turns());
    ASSERT_TRUE(calibration.gyro.calibration);
    EXPECT_THAT(calibration.gyro.calibration->has_scale, ElementsAre(false, false, true));
    EXPECT_EQ(calibration.gyro.calibration->M[0][0], 1.0);
    EXPECT_NEAR(calibration.gyro.calibration->M[2][2], 1.008, 0.02);
    EXPECT_THAT(calibration.gyro.undetermined, Contains("scale and misalignment of turns about x"));
    EXPECT_THAT(calibration.gyro.undetermined, Contains("g-sensitivity"));
}

// A reference needs no rest and no accelerometer.
TEST(GyroFit, AReferenceTellsTheMatrix) {
    const FaultySensor truth;
    MovedSensor moved(truth, 16);
    for (const Vector3& axis : faces()) { moved.turn(axis, 6.0, 4.0); }
    const Calibration calibration = calibrate({moved.recording("table.csv", false, true, false)});
    ASSERT_TRUE(calibration.gyro.calibration);
    const GyroCalibration& fitted = *calibration.gyro.calibration;
    EXPECT_FALSE(fitted.has_g_sensitivity);
    EXPECT_THAT(fitted.has_scale, ElementsAre(true, true, true));
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(fitted.M[i][j], truth.gyro_M[i][j], 2e-3) << i << j;
        }
    }
}

// One turn that went wrong by 5 deg where 0.06 are stated: its kind is believed less, the rests are not.
TEST(GyroFit, TurnsThatDisagreeAreBelievedLess) {
    MovedSensor moved({}, 17);
    whole_session(moved);
    for (const double error_rad : {0.09, -0.09}) {
        moved.turn({0, 0, 1}, 2.0 * std::numbers::pi + error_rad, 3.0);
        moved.rest(2.0);
    }
    const Calibration calibration = calibrate({moved.recording()}, with_turns());
    ASSERT_TRUE(calibration.gyro.calibration);
    for (const ObservationFit& fit : calibration.gyro.calibration->fits) {
        if (fit.kind == ObservationKind::turn) { EXPECT_GT(fit.sd_factor, 5.0); }
        if (fit.kind == ObservationKind::rest) { EXPECT_EQ(fit.sd_factor, 1.0); }
    }
    EXPECT_NEAR(calibration.gyro.calibration->M[2][2], 1.008, 0.01);
}

}  // namespace
}  // namespace gyrolog
