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
    EXPECT_GT(phases.scatter.force_degrees, 40.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Of so many degrees of freedom, four deviations.
        EXPECT_NEAR(phases.scatter.force_m_s2_sqrt_s[axis] / 0.002, 1.0, 4.0 / std::sqrt(2.0 * 42.0));
        EXPECT_NEAR(phases.scatter.rate_rad_s_sqrt_s[axis] / 0.0001, 1.0, 4.0 / std::sqrt(2.0 * 42.0));
    }
}

// Numbers that hardly leave one step of 0.15 m/s^2: a mean of any length is off by as much as one of them.
TEST(Rests, NoMeanIsBetterThanAStepThatTheNoiseDoesNotCross) {
    MovedSensor moved({}, 4);
    rest_in(moved, faces(), 8.0);
    Recording recording = moved.recording();
    constexpr double step_m_s2 = 0.15;
    for (Column& column : recording.columns) {
        if (column.name != "az") { continue; }
        for (double& value : std::get<std::vector<double>>(column.data)) {
            value = step_m_s2 / column.scale * std::round(value * column.scale / step_m_s2);
        }
    }
    const std::vector<InertialSignals> signals{inertial_signals(std::move(recording))};
    const Phases phases = find_phases(signals);
    EXPECT_NEAR(phases.scatter.force_sd_m_s2(8.0)[2], step_m_s2 / std::sqrt(12.0), 0.1 * step_m_s2);
    EXPECT_LT(phases.scatter.force_sd_m_s2(8.0)[0], 0.01 * step_m_s2);
}

// A recording without a gyro says nothing of how fast the others' gyro rests.
TEST(Rests, OfAnotherSensorLeaveThoseOfABiasedGyro) {
    MovedSensor moved({}, 5);
    rest_in(moved, faces(), 8.0);
    Recording with_both = moved.recording();
    Recording force_only = with_both;
    std::erase_if(force_only.columns, [](const Column& column) { return column.name.starts_with('g'); });
    for (Column& column : with_both.columns) {
        if (column.name != "gx") { continue; }
        for (double& value : std::get<std::vector<double>>(column.data)) {
            value += 20.0 * rad_per_deg / column.scale;
        }
    }
    const std::vector<InertialSignals> alone{inertial_signals(with_both)};
    const std::vector<InertialSignals> both{inertial_signals(std::move(force_only)),
                                            inertial_signals(std::move(with_both))};
    const Phases of_one = find_phases(alone);
    const Phases of_two = find_phases(both);
    EXPECT_EQ(of_two.rests.size(), 2 * of_one.rests.size());
    EXPECT_EQ(of_two.moves.size(), 2 * of_one.moves.size());
    EXPECT_EQ(of_two.scatter.rate_degrees, of_one.scatter.rate_degrees);
    EXPECT_EQ(of_two.scatter.force_degrees, 2.0 * of_one.scatter.force_degrees);
    EXPECT_NEAR(of_two.scatter.rate_rad_s_sqrt_s[0], of_one.scatter.rate_rad_s_sqrt_s[0], 1e-12);
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
