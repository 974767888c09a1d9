#include "analysis/calibrate/accelerometer_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::HasSubstr;

AccelerometerResult fit_of(const std::vector<Vector3>& poses, const FaultySensor& sensor = {},
                           std::uint64_t seed = 1) {
    MovedSensor moved(sensor, seed);
    rest_in(moved, poses, 4.0);
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(moved.recording()));
    const Phases phases = find_phases(signals);
    EXPECT_EQ(phases.rests.size(), poses.size());
    return fit_accelerometer(phases.rests, phases.scatter);
}

std::vector<Vector3> faces_and_edges() {
    std::vector<Vector3> poses = faces();
    poses.insert(poses.end(), edges().begin(), edges().end());
    return poses;
}

TEST(AccelerometerFit, TwelvePosesTellAllNineParameters) {
    const FaultySensor truth;
    const AccelerometerResult result = fit_of(faces_and_edges(), truth);
    ASSERT_TRUE(result.calibration);
    EXPECT_TRUE(result.undetermined.empty());
    const AccelerometerCalibration& fitted = *result.calibration;
    EXPECT_TRUE(fitted.has_misalignment);
    EXPECT_EQ(fitted.degrees, 3.0);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(fitted.M[i][j], truth.acc_M[i][j], 4.0 * fitted.M_sd[i][j]) << i << j;
            EXPECT_EQ(fitted.M_sd[i][j] > 0.0, j <= i);
        }
        EXPECT_NEAR(fitted.bias_m_s2[i], truth.acc_bias_m_s2[i], 4.0 * fitted.bias_sd_m_s2[i]);
        // 0.02 m/s^2 a sample, 400 samples a rest.
        EXPECT_LT(fitted.bias_sd_m_s2[i], 0.002);
    }
}

// The same law without noise: to rounding.
TEST(AccelerometerFit, IsExactWithoutNoise) {
    FaultySensor truth;
    truth.acc_noise_m_s2 = 1e-9;
    truth.gyro_noise_rad_s = 1e-9;
    const AccelerometerResult result = fit_of(faces_and_edges(), truth);
    ASSERT_TRUE(result.calibration);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(result.calibration->M[i][j], truth.acc_M[i][j], 1e-8);
        }
        EXPECT_NEAR(result.calibration->bias_m_s2[i], truth.acc_bias_m_s2[i], 1e-8);
    }
}

TEST(AccelerometerFit, SixFacesTellScaleAndBiasAndNoMisalignment) {
    FaultySensor truth;
    truth.acc_M = {{{1.012, 0.0, 0.0}, {0.0, 0.991, 0.0}, {0.0, 0.0, 1.004}}};
    const AccelerometerResult result = fit_of(faces(), truth);
    ASSERT_TRUE(result.calibration);
    EXPECT_FALSE(result.calibration->has_misalignment);
    EXPECT_EQ(result.undetermined.size(), 3U);
    EXPECT_THAT(result.undetermined, Contains("misalignment of y from x"));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(result.calibration->M[i][i], truth.acc_M[i][i], 4.0 * result.calibration->M_sd[i][i]);
    }
    // Faces are blind to misalignment: edges and corners are not.
    ASSERT_GE(result.advice.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) { EXPECT_THAT(result.advice[i].words, HasSubstr("the ")) << i; }
    EXPECT_THAT(result.advice.front().symbol, HasSubstr("M_"));
}

TEST(AccelerometerFit, TooFewPosesTellNothingAndWhatToAdd) {
    const AccelerometerResult result = fit_of({{0, 0, 1}, {0, 0, -1}, {1, 0, 0}});
    EXPECT_FALSE(result.calibration);
    EXPECT_THAT(result.undetermined, Contains("bias y"));
    EXPECT_GE(result.advice.size(), 4U);
    EXPECT_GT(result.advice.front().sd_before, result.advice.back().sd_after);
}

TEST(AccelerometerFit, ManyRestsInOnePoseTellNothing) {
    const AccelerometerResult result = fit_of({{0, 0, 1},
                                               {0, 1, 1},
                                               {0, 0, 1},
                                               {0, 1, 1},
                                               {0, 0, 1},
                                               {0, 1, 1},
                                               {0, 0, 1},
                                               {0, 1, 1},
                                               {0, 0, 1},
                                               {0, 1, 1},
                                               {0, 0, 1}});
    EXPECT_FALSE(result.calibration);
}

// The pose that is advised makes the parameter better known than any other would, by a fit with it added.
TEST(PoseAdvice, TheAdvisedPoseHelpsMoreThanAFaceAgain) {
    const AccelerometerResult before = fit_of(faces_and_edges());
    ASSERT_TRUE(before.calibration);
    const PoseAdvice best = before.advice.front();
    std::vector<Vector3> with_best = faces_and_edges();
    with_best.push_back(best.up);
    const AccelerometerResult after = fit_of(with_best);
    ASSERT_TRUE(after.calibration);
    double determinant_change = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_LT(after.calibration->covariance(i, i), before.calibration->covariance(i, i) * 1.2);
        determinant_change +=
            std::log(after.calibration->covariance(i, i) / before.calibration->covariance(i, i));
    }
    EXPECT_LT(determinant_change, 0.0);
}

// Rests that disagree by more than their noise: one is off by 3 % of gravity.
TEST(AccelerometerFit, RestsThatDisagreeRaiseTheUncertainty) {
    MovedSensor moved({}, 7);
    std::vector<Vector3> poses = faces_and_edges();
    rest_in(moved, poses, 4.0);
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(moved.recording()));
    Phases phases = find_phases(signals);
    const AccelerometerResult good = fit_accelerometer(phases.rests, phases.scatter);
    phases.rests[3].force_m_s2[1] += 0.3;
    const AccelerometerResult bad = fit_accelerometer(phases.rests, phases.scatter);
    ASSERT_TRUE(good.calibration && bad.calibration);
    EXPECT_EQ(good.calibration->sd_factor, 1.0);
    EXPECT_GT(bad.calibration->sd_factor, 5.0);
}

}  // namespace
}  // namespace gyrolog
