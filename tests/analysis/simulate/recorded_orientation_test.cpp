#include "analysis/simulate/recorded_orientation.hpp"

#include <cmath>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/support/posed_recording.hpp"

namespace gyrolog {
namespace {

constexpr double g = standard_gravity_m_s2;
const double half = std::sqrt(0.5);

void expect_force(const Quaternion& orientation, const Vector3& in_g) {
    const Vector3 force = force_at_rest(orientation);
    for (std::size_t axis = 0; axis < 3; ++axis) { EXPECT_NEAR(force[axis], in_g[axis] * g, 1e-12) << axis; }
}

// The axis that the turn brought upward.
TEST(ForceAtRest, IsUpwardInTheSensorsAxes) {
    expect_force({1, 0, 0, 0}, {0, 0, 1});
    expect_force({half, half, 0, 0}, {0, 1, 0});
    expect_force({half, 0, half, 0}, {-1, 0, 0});
    expect_force({half, 0, 0, half}, {0, 0, 1});
    expect_force({0, 1, 0, 0}, {0, 0, -1});
}

TEST(ForceAtRest, TakesQuaternionsOfAnyLengthAndSign) {
    expect_force({-2.0 * half, -2.0 * half, 0, 0}, {0, 1, 0});
    EXPECT_TRUE(std::isnan(force_at_rest({std::nan(""), 0, 0, 0})[0]));
    EXPECT_TRUE(std::isnan(force_at_rest({0, 0, 0, 0})[0]));
}

SensorModel with_faults() {
    SensorModel model = typical_mpu9250();
    AccelerometerModel& accelerometer = model.accelerometer.emplace();
    for (AxisModel& axis : accelerometer.axes) { axis.noise.N_rad_per_sqrt_s = 1e-6 * g; }
    accelerometer.axes[1].bias_rad_s = 0.1 * g;
    accelerometer.M[2][0] = 0.02;
    accelerometer.effects = {{"scale_factor", {"x"}, {{"eps", 0.01}}, {}},
                             {"misalignment", {"y"}, {{"from_z", 0.003}}, {}}};
    return model;
}

Recording simulated_in_poses(bool accelerometer_in_poses, const Recording& poses) {
    SimulationRequest request;
    request.like = std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(poses));
    request.accelerometer_in_poses = accelerometer_in_poses;
    return simulate_recording(with_faults(), request);
}

double mean_in_g(const Recording& recording, const char* name, std::size_t first, std::size_t rows) {
    const std::vector<double> values = recording.find(name)->values();
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(rows), 0.0) /
           static_cast<double>(rows) / g;
}

TEST(AccelerometerInPoses, ShowsGravityWithItsMatrixItsBiasAndItsEffects) {
    const Recording seen = simulated_in_poses(true, PosedRecording({.rest_s = 4.0}).recording());
    // At rest with z upward, and in the last rest with x upward: the noise of a mean is 1e-6 g.
    const std::size_t last = seen.rows() - 300;
    EXPECT_NEAR(mean_in_g(seen, "ax", 50, 300), 0.0, 1e-5);
    EXPECT_NEAR(mean_in_g(seen, "ay", 50, 300), 0.103, 1e-5);
    EXPECT_NEAR(mean_in_g(seen, "az", 50, 300), 1.0, 1e-5);
    EXPECT_NEAR(mean_in_g(seen, "ax", last, 300), 1.01, 1e-5);
    EXPECT_NEAR(mean_in_g(seen, "ay", last, 300), 0.1, 1e-5);
    EXPECT_NEAR(mean_in_g(seen, "az", last, 300), 0.02, 1e-5);
}

TEST(AccelerometerInPoses, IsThereWhereAskedForAndNotRecorded) {
    Recording poses = PosedRecording({.rest_s = 4.0}).recording();
    EXPECT_EQ(simulated_in_poses(false, poses).find("ax"), nullptr);
    for (const char* name : {"ax", "ay", "az"}) {
        poses.columns.push_back({name, "m/s^2", std::vector<double>(poses.rows(), 7.0)});
    }
    EXPECT_EQ(mean_in_g(simulated_in_poses(true, poses), "ax", 0, 100) * g, 7.0);
    std::erase_if(poses.columns, [](const Column& column) { return column.name == "ref_qw"; });
    EXPECT_FALSE(has_orientation(poses));
}

}  // namespace
}  // namespace gyrolog
