#include "analysis/simulate/recorded_world.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/orientation_rate.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Column reals(const std::string& name, const std::string& unit, std::vector<double> values) {
    return {name, unit, std::move(values), 1.0, 0.0, {}};
}

// With rows at these slots; each column is a function of the slot.
struct Maker {
    std::vector<std::int64_t> slots;
    double rate_hz = 100.0;

    template <typename F>
    std::vector<double> column(F f) const {
        std::vector<double> values;
        for (const std::int64_t slot : slots) { values.push_back(f(static_cast<double>(slot) / rate_hz)); }
        return values;
    }
    std::shared_ptr<const Recording> recording(std::vector<Column> columns) const {
        auto recording = std::make_shared<Recording>();
        recording->rate_hz = rate_hz;
        recording->columns = std::move(columns);
        for (std::size_t row = 0; row < slots.size(); ++row) {
            if (row == 0 || slots[row] != slots[row - 1] + 1) {
                recording->segments.push_back({row, 0, slots[row]});
            }
            ++recording->segments.back().count;
        }
        return recording;
    }
};

Maker unbroken(std::int64_t rows, double rate_hz = 100.0) {
    Maker maker{{}, rate_hz};
    for (std::int64_t slot = 0; slot < rows; ++slot) { maker.slots.push_back(slot); }
    return maker;
}

struct Motion {
    std::array<double, 3> rate_rad_s{};
    std::array<double, 3> force_m_s2{};
};

Motion motion_at(const World& world, double world_s) {
    Motion motion;
    world.motion({&world_s, 1},
                 {std::span(&motion.rate_rad_s[0], 1), std::span(&motion.rate_rad_s[1], 1),
                  std::span(&motion.rate_rad_s[2], 1)},
                 {std::span(&motion.force_m_s2[0], 1), std::span(&motion.force_m_s2[1], 1),
                  std::span(&motion.force_m_s2[2], 1)});
    return motion;
}

double temperature_at(const World& world, double world_s) {
    double temperature_C = 0.0;
    world.temperature({&world_s, 1}, {&temperature_C, 1});
    return temperature_C;
}

TEST(RecordedWorld, OfRatesAloneIsAtRestWithoutTemperature) {
    const RecordedWorld world(unbroken(10).recording({reals("gx", "rad/s", std::vector<double>(10))}));
    EXPECT_FALSE(world.moves());
    EXPECT_FALSE(world.is_measured());
    EXPECT_FALSE(world.has_temperature());
    EXPECT_TRUE(world.warnings().empty());
}

TEST(RecordedWorld, BetweenSamplesACubicIsMetExactly) {
    const Maker maker = unbroken(50);
    const auto cubic = [](double t_s) {
        return 1.0 + 20.0 * t_s - 300.0 * t_s * t_s + 500.0 * t_s * t_s * t_s;
    };
    const RecordedWorld world(
        maker.recording({reals("ref_x", "rad/s", maker.column(cubic)),
                         reals("ref_y", "rad/s", maker.column([](double) { return 2.0; })),
                         reals("ref_z", "rad/s", maker.column([](double) { return 3.0; }))}));
    EXPECT_TRUE(world.moves());
    EXPECT_TRUE(world.is_measured());
    for (double world_s = 0.01; world_s <= 0.48; world_s += 0.0037) {
        const Motion motion = motion_at(world, world_s);
        EXPECT_NEAR(motion.rate_rad_s[0], cubic(world_s), 1e-12);
        EXPECT_EQ(motion.rate_rad_s[1], 2.0);
        EXPECT_EQ(motion.force_m_s2[2], 9.80665);
    }
}

TEST(RecordedWorld, HoldsTheEndsAndJoinsAHoleByAStraightLine) {
    const Maker maker{{0, 1, 2, 3, 10, 11, 12}};
    const auto square = [](double t_s) { return t_s * t_s; };
    const RecordedWorld world(maker.recording({reals("ref_x", "rad/s", maker.column(square)),
                                               reals("ref_y", "rad/s", maker.column(square)),
                                               reals("ref_z", "rad/s", maker.column(square))}));
    const auto at = [&](double slot) { return motion_at(world, slot / 100.0).rate_rad_s[0]; };
    EXPECT_NEAR(at(1.5), 1.5e-2 * 1.5e-2, 1e-15);
    EXPECT_NEAR(at(2.5), (4e-4 + 9e-4) / 2.0, 1e-15);    // at the hole's edge: no fourth neighbour
    EXPECT_NEAR(at(6.5), (9e-4 + 100e-4) / 2.0, 1e-15);  // within
    EXPECT_NEAR(at(10.5), (100e-4 + 121e-4) / 2.0, 1e-15);
    EXPECT_EQ(at(-5.0), 0.0);
    EXPECT_NEAR(at(50.0), 144e-4, 1e-15);
}

TEST(RecordedWorld, WhatIsNotKnownIsJoinedAndSaid) {
    const Maker maker = unbroken(6);
    const RecordedWorld world(maker.recording({reals("ref_x", "rad/s", {nan, 1.0, nan, nan, 4.0, nan}),
                                               reals("ref_y", "rad/s", std::vector<double>(6, nan))}));
    const double expected[] = {1.0, 1.0, 2.0, 3.0, 4.0, 4.0};
    for (int slot = 0; slot < 6; ++slot) {
        const Motion motion = motion_at(world, slot / 100.0);
        EXPECT_NEAR(motion.rate_rad_s[0], expected[slot], 1e-12);
        EXPECT_EQ(motion.rate_rad_s[1], 0.0);
    }
    ASSERT_EQ(world.warnings().size(), 3U);
    EXPECT_EQ(world.warnings()[0], "no reference rate of axis z: taken as not turning");
    EXPECT_EQ(world.warnings()[1], "the reference rate of axis y is known nowhere: taken as not recorded");
    EXPECT_EQ(
        world.warnings()[2],
        "the reference rate is not known in 4 of 6 samples: joined by straight lines there, held at the "
        "ends");
}

TEST(RecordedWorld, AnAccelerometerWithoutReferenceIsASensorThatDoesNotTurn) {
    const Maker maker = unbroken(8);
    const RecordedWorld world(maker.recording({reals("ax", "m/s^2", std::vector<double>(8, 1.0)),
                                               reals("ay", "m/s^2", std::vector<double>(8, 2.0)),
                                               reals("az", "m/s^2", std::vector<double>(8, 9.0))}));
    EXPECT_TRUE(world.moves());
    EXPECT_FALSE(world.is_measured());  // nothing of a reference's noise is in a rate of zero
    EXPECT_EQ(motion_at(world, 0.03).rate_rad_s[2], 0.0);
    EXPECT_EQ(motion_at(world, 0.03).force_m_s2[0], 1.0);
}

// A turn at a constant rate about a fixed axis: q(t) = (cos(w t / 2), n sin(w t / 2)).
Quaternion turned(const std::array<double, 3>& rate_rad_s, double t_s) {
    const double speed = std::hypot(rate_rad_s[0], rate_rad_s[1], rate_rad_s[2]);
    const double sine = std::sin(speed * t_s / 2.0) / speed;
    return {std::cos(speed * t_s / 2.0), rate_rad_s[0] * sine, rate_rad_s[1] * sine, rate_rad_s[2] * sine};
}

TEST(OrientationRate, OfASteadyTurnIsItsRateInTheSensorsAxes) {
    // First turned away from the world by 90 degrees about z, then turning about its own x, y and z.
    const Quaternion away = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    const std::array<double, 3> rate_rad_s = {8.0, -11.0, 23.0};
    std::vector<Quaternion> orientation;
    for (int k = 0; k < 200; ++k) {
        const Quaternion q = turned(rate_rad_s, k * 0.01);
        Quaternion total = {away[0] * q[0] - away[3] * q[3], away[0] * q[1] - away[3] * q[2],
                            away[0] * q[2] + away[3] * q[1], away[0] * q[3] + away[3] * q[0]};
        if (k % 3 == 1) {
            for (double& part : total) { part = -part; }  // the same orientation
        }
        orientation.push_back(total);
    }
    for (const auto& rate : orientation_rate(orientation, 100.0)) {
        for (std::size_t axis = 0; axis < 3; ++axis) { EXPECT_NEAR(rate[axis], rate_rad_s[axis], 1e-10); }
    }
}

TEST(OrientationRate, OfLargeAndTinyTurnsIsExact) {
    for (const double angle_rad : {1e-12, 1e-3, 0.5, 1.5707963, 2.0, 3.0, 3.14159}) {
        const auto phi = rotation_vector({std::cos(angle_rad / 2.0), 0.0, std::sin(angle_rad / 2.0), 0.0});
        EXPECT_NEAR(phi[1] / angle_rad, 1.0, 1e-12) << angle_rad;
        EXPECT_EQ(phi[0], 0.0);
    }
    EXPECT_EQ(rotation_vector({1.0, 0.0, 0.0, 0.0})[0], 0.0);
}

TEST(OrientationRate, IsUnknownOnlyWhereTheOrientationIsForLongerThanTheFitsHalfWidth) {
    std::vector<Quaternion> orientation;
    for (int k = 0; k < 40; ++k) { orientation.push_back(turned({0.0, 0.0, 1.0}, k * 0.01)); }
    for (const std::size_t k : {0U, 7U, 8U, 9U, 10U, 20U, 21U, 22U, 23U, 24U, 39U}) {
        orientation[k][1] = nan;  // four rows are bridged, five are 60 ms from one known to the next
    }
    const auto rates = orientation_rate(orientation, 100.0);
    for (std::size_t k = 0; k < 40; ++k) {
        if (k == 0 || (k >= 20 && k <= 24) || k == 39) {
            EXPECT_TRUE(std::isnan(rates[k][2])) << k;
        } else {
            EXPECT_NEAR(rates[k][2], 1.0, 1e-10) << k;
        }
    }
}

TEST(TurnRate, OfASwingIsItsRateToTheFourthOrder) {
    for (const double f_hz : {1.0, 5.0, 10.0}) {
        std::vector<Quaternion> orientation;
        const double pulsation_rad_s = 2.0 * pi * f_hz;
        for (int k = 0; k < 400; ++k) {
            orientation.push_back(turned({0.0, 1.0, 0.0}, 0.1 * std::sin(pulsation_rad_s * k * 0.005)));
        }
        const auto rates = turn_rate(orientation, 200.0);
        const double w = pulsation_rad_s / 200.0;
        // The series' next term is w^6/140.
        const double off = 0.1 * pulsation_rad_s * (w * w * w * w / 30.0);
        for (int k = 2; k < 398; ++k) {
            const double rate_rad_s = 0.1 * pulsation_rad_s * std::cos(pulsation_rad_s * k * 0.005);
            EXPECT_NEAR(rates[static_cast<std::size_t>(k)][1], rate_rad_s, 1.1 * off + 1e-12) << f_hz;
        }
    }
}

// Whatever the orientation's errors, their sum is that of the ends.
TEST(TurnRate, OfErrorsSumsUpToThoseOfTheEnds) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> error_rad(0.0, 1e-3);
    std::vector<Quaternion> orientation;
    for (int k = 0; k < 1000; ++k) { orientation.push_back(turned({0.0, 0.0, 1.0}, error_rad(random))); }
    double sum = 0.0;
    double squares = 0.0;
    for (const auto& rate : turn_rate(orientation, 100.0)) {
        sum += rate[2];
        squares += rate[2] * rate[2];
    }
    EXPECT_LT(std::fabs(sum), 100.0 * 6e-3);
    EXPECT_GT(std::sqrt(squares / 1000.0), 0.05);
}

TEST(TurnRate, TurnsEvenlyWhereTheOrientationIsNotKnown) {
    std::vector<Quaternion> orientation;
    for (int k = 0; k < 40; ++k) { orientation.push_back(turned({0.0, 0.0, 1.0}, k * 0.01)); }
    for (int k : {0, 1, 10, 11, 12, 39}) { orientation[static_cast<std::size_t>(k)][1] = nan; }
    const auto rates = turn_rate(orientation, 100.0);
    for (std::size_t k = 0; k < rates.size(); ++k) {
        const bool is_known = k >= 2 && k < 39;
        EXPECT_EQ(std::isnan(rates[k][2]), !is_known) << k;
        if (is_known) { EXPECT_NEAR(rates[k][2], 1.0, 1e-9) << k; }
    }
}

TEST(OrientationRate, OfASwingIsLessByTheGainOfACubic) {
    for (const double f_hz : {2.0, 4.8, 12.5}) {
        const double pulsation_rad_s = 2.0 * 3.14159265358979 * f_hz;
        std::vector<Quaternion> orientation;
        for (int k = 0; k < 2000; ++k) {
            orientation.push_back(turned({0.0, 1.0, 0.0}, 0.1 * std::sin(pulsation_rad_s * k * 0.001)));
        }
        const auto rates = orientation_rate(orientation, 1000.0);
        const double u = pulsation_rad_s * 0.05;
        const double j1 = std::sin(u) / (u * u) - std::cos(u) / u;
        const double j3 =
            (15.0 / (u * u * u) - 6.0 / u) * std::sin(u) / u - (15.0 / (u * u) - 1.0) * std::cos(u) / u;
        const double gain = (3.0 * j1 + 10.5 * j3) / u;
        EXPECT_NEAR(gain, f_hz == 2.0 ? 0.9997 : f_hz == 4.8 ? 0.99 : std::sqrt(0.5), 0.005);
        for (std::size_t k = 50; k < 1950; ++k) {
            const double rate_rad_s =
                0.1 * pulsation_rad_s * std::cos(pulsation_rad_s * static_cast<double>(k) * 0.001);
            // 101 rows are 1 % wider than the 100 ms of the formula; the gain falls by 4 u^4 / 504 for each.
            ASSERT_NEAR(rates[k][1], gain * rate_rad_s,
                        0.1 * pulsation_rad_s * (1e-4 + 0.015 * std::pow(u, 4.0) * 4.0 / 504.0))
                << k;
        }
    }
}

TEST(OrientationRate, HasTheNoiseThatAFitLeavesOfTheOrientations) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> error_rad(0.0, 1e-3);
    std::vector<Quaternion> orientation;
    for (int k = 0; k < 40'000; ++k) {
        orientation.push_back({1.0, error_rad(random) / 2.0, error_rad(random) / 2.0, 0.0});
    }
    const auto rates = orientation_rate(orientation, 1000.0);
    double squares = 0.0;
    for (const auto& rate : rates) { squares += rate[0] * rate[0]; }
    // Of a line, and 5/2 of it for the cubic of many rows: with 101 of them 1 % off.
    const double expected_rad_s = 2.5e-3 * 1000.0 * std::sqrt(3.0 / (50.0 * 51.0 * 101.0));
    // At least one independent value in 101.
    EXPECT_NEAR(std::sqrt(squares / 40e3) / expected_rad_s, 1.0, 0.01 + 4.0 / std::sqrt(2.0 * 40e3 / 101.0));
}

TEST(RecordedWorld, StandsStillWhereTheOrientationIsLongUnknownAndGoesOnAcrossAMoment) {
    const Maker maker = unbroken(400);
    const auto known = [](double t_s) {
        return t_s > 0.495 && (t_s < 1.495 || t_s > 1.565) && (t_s < 2.495 || t_s > 2.695) && t_s < 3.495;
    };
    std::vector<Column> columns;
    for (std::size_t part = 0; part < 4; ++part) {
        columns.push_back(reals(std::string("ref_q") + "wxyz"[part], "", maker.column([&](double t_s) {
            return known(t_s) ? turned({0.0, 2.0, 0.0}, t_s)[part] : nan;
        })));
    }
    const RecordedWorld world(maker.recording(std::move(columns)));
    for (std::size_t slot = 0; slot < 400; ++slot) {
        const bool turns = slot >= 50 && slot < 350 && (slot < 250 || slot > 269);
        EXPECT_NEAR(motion_at(world, static_cast<double>(slot) / 100.0).rate_rad_s[1], turns ? 2.0 : 0.0,
                    1e-10)
            << slot;
    }
    ASSERT_EQ(world.warnings().size(), 2U);
    EXPECT_EQ(world.warnings()[0],
              "the reference rate is not known in 120 of 400 samples for longer than a moment: taken as not "
              "turning there");
    EXPECT_EQ(world.warnings()[1],
              "the reference rate is not known in 7 of 400 samples: joined by straight lines there, held at "
              "the ends");
}

TEST(RecordedWorld, TakesTheRateOfAnOrientationWhereThereIsNoReferenceRate) {
    const Maker maker = unbroken(100);
    std::vector<Column> columns;
    for (std::size_t part = 0; part < 4; ++part) {
        columns.push_back(reals(std::string("ref_q") + "wxyz"[part], "", maker.column([&](double t_s) {
            return turned({0.0, 2.0, 0.0}, t_s)[part];
        })));
    }
    const RecordedWorld world(maker.recording(std::move(columns)));
    EXPECT_TRUE(world.is_measured());
    EXPECT_NEAR(motion_at(world, 0.5).rate_rad_s[1], 2.0, 1e-10);
    EXPECT_NEAR(motion_at(world, 0.5).rate_rad_s[0], 0.0, 1e-10);
}

// Sum of squares about their mean.
double squares_about_mean(const std::vector<double>& values) {
    double mean = 0.0;
    for (const double value : values) { mean += value / static_cast<double>(values.size()); }
    double squares = 0.0;
    for (const double value : values) { squares += (value - mean) * (value - mean); }
    return squares;
}

TEST(RecordedWorld, OfARealOrientationHasTheNoiseAtRestThatMethodsStates) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    auto read =
        read_recording_csv(shared_data("broad_ref_motion/05_undisturbed_slow_rotation_with_breaks_B.csv.xz"));
    ASSERT_TRUE(read) << read.error().message;
    const auto recording = std::make_shared<const Recording>(std::move(*read));
    const RecordedWorld world(recording);
    // The last rest, between two turns of the hand and the loss of the markers: rows 51300 to 58200.
    constexpr std::size_t first = 51300;
    constexpr std::size_t last = 58200;
    constexpr double stated_real_dps[] = {0.10, 0.09, 0.10};
    constexpr double stated_dps[] = {1.47, 1.12, 0.43};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column& gyro = *recording->find(std::string("g") + "xyz"[axis]);
        std::vector<double> real_dps;
        std::vector<double> simulated_dps;
        for (std::size_t row = first; row < last; ++row) {
            real_dps.push_back(gyro.value(row) * deg_per_rad);
            simulated_dps.push_back(
                motion_at(world, static_cast<double>(row) / recording->rate_hz).rate_rad_s[axis] *
                deg_per_rad);
        }
        const double count = last - first;
        const double real_sd_dps = std::sqrt(squares_about_mean(real_dps) / count);
        const double simulated_sd_dps = std::sqrt(squares_about_mean(simulated_dps) / count);
        EXPECT_NEAR(real_sd_dps, stated_real_dps[axis], 0.005);
        EXPECT_NEAR(simulated_sd_dps, stated_dps[axis], 0.01);
    }
    // The markers are not seen for the first 4 s.
    for (double world_s = 0.0; world_s < 4.0; world_s += 0.01) {
        EXPECT_EQ(motion_at(world, world_s).rate_rad_s, (std::array<double, 3>{})) << world_s;
    }
}

TEST(RecordedWorld, TheThermometersNoiseDoesNotReachTheDie) {
    const Maker maker = unbroken(60'000);
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise_C(0.0, 0.03);
    const auto truth_C = [](double t_s) { return 25.0 + 5.0 * (1.0 - std::exp(-t_s / 60.0)); };
    const RecordedWorld world(maker.recording(
        {reals("temp", "degC", maker.column([&](double t_s) { return truth_C(t_s) + noise_C(random); }))}));
    ASSERT_TRUE(world.has_temperature());
    double squares = 0.0;
    int count = 0;
    for (double t_s = 300.0; t_s < 590.0; t_s += 1.0) {
        const double off_C = temperature_at(world, t_s) - truth_C(t_s);
        squares += off_C * off_C;
        ++count;
    }
    // A line through 1001 samples: 1/sqrt(1001) of the noise at its middle. 29 windows are independent.
    EXPECT_NEAR(std::sqrt(squares / count) / (0.03 / std::sqrt(1001.0)), 1.0, 4.0 / std::sqrt(2.0 * 29.0));
    // The settling is followed to 1e-3 of its excursion where it has a window on either side.
    for (double t_s = 5.0; t_s < 100.0; t_s += 0.7) {
        EXPECT_NEAR(temperature_at(world, t_s), truth_C(t_s), 5.0 * 1e-3 + 4.0 * 0.03 / std::sqrt(1001.0));
    }
}

TEST(RecordedWorld, ASteadyDriftOfTheTemperatureIsMetToTheEnds) {
    const Maker maker = unbroken(3000);
    const auto drift_C = [](double t_s) { return 20.0 + 0.1 * t_s; };
    const RecordedWorld world(maker.recording({reals("temp", "degC", maker.column(drift_C))}));
    for (const double t_s : {0.0, 0.3, 2.0, 15.5, 28.0, 29.9}) {
        EXPECT_NEAR(temperature_at(world, t_s), drift_C(t_s), 1e-9);
    }
}

TEST(RecordedWorld, TheTemperatureIsStraightAcrossAHole) {
    Maker maker{{}};
    for (std::int64_t slot = 0; slot < 100'000'000'000; slot += slot == 2999 ? 99'999'996'001 : 1) {
        maker.slots.push_back(slot);
    }
    const RecordedWorld world(
        maker.recording({reals("temp", "degC", maker.column([](double t_s) { return 20.0 + 1e-8 * t_s; }))}));
    EXPECT_NEAR(temperature_at(world, 5e8), 25.0, 1e-6);  // and no memory for the 30 years between
    EXPECT_NEAR(temperature_at(world, 15.0), 20.0, 1e-6);
}

}  // namespace
}  // namespace gyrolog
