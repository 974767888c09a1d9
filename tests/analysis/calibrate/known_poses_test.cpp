#include "analysis/calibrate/known_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/recorded_orientation.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/support/posed_recording.hpp"

namespace gyrolog {
namespace {

Recording six_poses_seen() {
    SensorModel model = typical_mpu9250();
    AccelerometerModel& accelerometer = model.accelerometer.emplace();
    for (AxisModel& axis : accelerometer.axes) {
        axis.noise.N_rad_per_sqrt_s = 150e-6 * standard_gravity_m_s2;
    }
    SimulationRequest request;
    request.like = std::make_shared<const RecordedWorld>(
        std::make_shared<const Recording>(PosedRecording({.rest_s = 5.0}).recording()));
    request.accelerometer_in_poses = true;
    return simulate_recording(model, request);
}

// Five seconds of rest each, less half a second at either end at the most.
TEST(RestsInPoses, AreTheSixWithGravityInTheirAxes) {
    const RestsInPoses posed = rests_in_poses(six_poses_seen());
    ASSERT_EQ(posed.rests, 6U);
    EXPECT_GT(posed.resting_s, 6 * 4.0);
    EXPECT_LE(posed.resting_s, 6 * 5.0);
    ASSERT_EQ(posed.recording.segments.size(), 6U);
    const Column& x = *posed.recording.find("ref_ax");
    const Column& y = *posed.recording.find("ref_ay");
    const Column& z = *posed.recording.find("ref_az");
    const double g = standard_gravity_m_s2;
    const Vector3 upward[] = {{0, 0, g}, {0, g, 0}, {0, 0, -g}, {0, -g, 0}, {-g, 0, 0}, {g, 0, 0}};
    for (std::size_t rest = 0; rest < 6; ++rest) {
        const Segment& segment = posed.recording.segments[rest];
        for (const std::size_t row : {segment.first, segment.first + segment.count - 1}) {
            const Vector3 force{x.value(row), y.value(row), z.value(row)};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(force[axis], upward[rest][axis], 1e-9) << rest << " " << axis;
            }
        }
    }
    EXPECT_NEAR(posed.up[2], 1.0, 1e-6);
}

// Six poses at rest take 30 s of 40.
TEST(RestsInPoses, HaveNoRowOfATurn) {
    const Recording whole = six_poses_seen();
    const RestsInPoses posed = rests_in_poses(whole);
    for (const Segment& segment : posed.recording.segments) {
        const std::int64_t last = segment.first_index + static_cast<std::int64_t>(segment.count) - 1;
        for (const std::int64_t index : {segment.first_index, last}) {
            const double within_s = std::fmod(static_cast<double>(index) / whole.rate_hz, 7.0);
            EXPECT_LT(within_s, 5.0) << "sampling instant " << index;
        }
    }
}

TEST(RestsInPoses, LeaveOutOneWhosePoseNobodyKnows) {
    Recording whole = six_poses_seen();
    for (Column& column : whole.columns) {
        if (!column.name.starts_with("ref_q")) { continue; }
        std::vector<double> values = column.values();
        std::fill(values.begin() + 700, values.begin() + 1200, std::nan(""));
        column.data = values;
    }
    EXPECT_EQ(rests_in_poses(whole).rests, 5U);
}

// (h, -h, 0, 0) times the quaternion turns the world's z axis to where its y axis was.
TEST(RestsInPoses, TellWhereTheForcesPointInAWorldWhoseYAxisIsUpward) {
    const Recording seen = six_poses_seen();
    const double h = std::sqrt(0.5);
    const std::vector<double> w = seen.find("ref_qw")->values();
    const std::vector<double> x = seen.find("ref_qx")->values();
    const std::vector<double> y = seen.find("ref_qy")->values();
    const std::vector<double> z = seen.find("ref_qz")->values();
    std::array<std::vector<double>, 4> turned;
    for (std::size_t i = 0; i < w.size(); ++i) {
        turned[0].push_back(h * (w[i] + x[i]));
        turned[1].push_back(h * (x[i] - w[i]));
        turned[2].push_back(h * (y[i] + z[i]));
        turned[3].push_back(h * (z[i] - y[i]));
    }
    Recording whole = seen;
    for (Column& column : whole.columns) {
        if (!column.name.starts_with("ref_q")) { continue; }
        column.data = turned.at(std::string_view("wxyz").find(column.name.back()));
    }
    const RestsInPoses posed = rests_in_poses(whole);
    EXPECT_EQ(posed.rests, 6U);
    EXPECT_NEAR(posed.up[1], 1.0, 1e-6);
}

TEST(RestsInPoses, AreNoneWithoutThreeForces) {
    Recording whole = six_poses_seen();
    std::erase_if(whole.columns, [](const Column& column) { return column.name == "ay"; });
    EXPECT_EQ(rests_in_poses(whole).rests, 0U);
}

}  // namespace
}  // namespace gyrolog
