#include "analysis/calibrate/rests.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {
namespace {

std::vector<InertialSignals> signals_of(const MovedSensor& moved) {
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(moved.recording()));
    return signals;
}

TEST(Rests, AreFoundBetweenMoves) {
    MovedSensor moved({}, 1);
    moved.rest(3.0);
    rest_in(moved, faces(), 2.0);
    const Phases phases = find_phases(signals_of(moved));
    // z up at first, x, y, -x, -y, z, -z.
    ASSERT_EQ(phases.rests.size(), 7U);
    EXPECT_EQ(phases.moves.size(), 6U);
    EXPECT_NEAR(phases.rests[0].from_s, 0.0, 0.26);
    EXPECT_NEAR(phases.rests[1].from_s, 4.5, 0.5);
    EXPECT_NEAR(phases.rests[0].force_m_s2[2], 0.12 + 1.004 * standard_gravity_m_s2, 0.01);
}

// White noise of 0.02 m/s^2 a sample at 100 Hz.
TEST(Rests, TellHowWellAMeanIsKnown) {
    MovedSensor moved({}, 2);
    rest_in(moved, faces(), 8.0);
    const Phases phases = find_phases(signals_of(moved));
    EXPECT_GT(phases.scatter.degrees, 40.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Of so many degrees of freedom, four deviations.
        EXPECT_NEAR(phases.scatter.force_m_s2_sqrt_s[axis] / 0.002, 1.0, 4.0 / std::sqrt(2.0 * 42.0));
        EXPECT_NEAR(phases.scatter.rate_rad_s_sqrt_s[axis] / 0.0001, 1.0, 4.0 / std::sqrt(2.0 * 42.0));
    }
}

TEST(Rests, AConstantRateIsNone) {
    MovedSensor moved({}, 3);
    moved.rest(10.0);
    Recording recording = moved.recording();
    auto& z = std::get<std::vector<double>>(recording.columns[2].data);
    for (std::size_t row = 600; row < z.size(); ++row) { z[row] += 1.0; }
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(std::move(recording)));
    const Phases phases = find_phases(signals);
    ASSERT_EQ(phases.rests.size(), 1U);
    EXPECT_NEAR(phases.rests[0].duration_s, 5.5, 0.3);
}

TEST(Rests, ASlowTiltIsNone) {
    FaultySensor sensor;
    sensor.gyro_noise_rad_s = 0.1;  // hides the rate
    MovedSensor moved(sensor, 4);
    moved.turn({1, 0, 0}, 0.05, 20.0);
    EXPECT_TRUE(find_phases(signals_of(moved)).rests.empty());
}

TEST(Rests, RowsWithoutForceAreLeftOut) {
    MovedSensor moved({}, 5);
    moved.rest(10.0);
    Recording recording = moved.recording();
    auto& x = std::get<std::vector<double>>(recording.columns[3].data);
    for (std::size_t row = 300; row < 400; ++row) { x[row] = std::nan(""); }
    std::vector<InertialSignals> signals;
    signals.push_back(inertial_signals(std::move(recording)));
    const Phases phases = find_phases(signals);
    ASSERT_EQ(phases.rests.size(), 2U);
    EXPECT_TRUE(phases.moves.empty()) << "what happened meanwhile is not known";
    EXPECT_TRUE(std::isfinite(phases.rests[0].force_m_s2[0]));
}

}  // namespace
}  // namespace gyrolog
