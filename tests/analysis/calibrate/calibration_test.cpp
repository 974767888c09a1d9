#include "analysis/calibrate/calibration.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/calibrate/calibrated_model.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

CalibrationOptions with_turns(double turn_sd_rad) {
    CalibrationOptions options;
    options.observations.turn_rad = 2.0 * std::numbers::pi;
    options.observations.turn_sd_rad = turn_sd_rad;
    return options;
}

std::map<std::string, double> truth_of(const FaultySensor& sensor) {
    std::map<std::string, double> truth;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string row = axis_names[i];
        truth["acc bias_" + row] = sensor.acc_bias_m_s2[i];
        truth["gyro bias_" + row] = sensor.gyro_bias_rad_s[i];
        for (std::size_t j = 0; j < 3; ++j) {
            truth["acc M_" + row + axis_names[j]] = sensor.acc_M[i][j];
            truth["gyro M_" + row + axis_names[j]] = sensor.gyro_M[i][j];
            truth["gyro K_" + row + axis_names[j]] = sensor.K_s_per_m[i][j];
        }
    }
    return truth;
}

struct Fitted {
    double value = 0.0;
    double sd = 0.0;
};

std::map<std::string, Fitted> fitted_of(const Calibration& calibration) {
    std::map<std::string, Fitted> fitted;
    const AccelerometerCalibration& acc = *calibration.accelerometer.calibration;
    const GyroCalibration& gyro = *calibration.gyro.calibration;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string row = axis_names[i];
        fitted["acc bias_" + row] = {acc.bias_m_s2[i], acc.bias_sd_m_s2[i]};
        fitted["gyro bias_" + row] = {gyro.bias_rad_s[i], gyro.bias_sd_rad_s[i]};
        for (std::size_t j = 0; j < 3; ++j) {
            if (j <= i) { fitted["acc M_" + row + axis_names[j]] = {acc.M[i][j], acc.M_sd[i][j]}; }
            fitted["gyro M_" + row + axis_names[j]] = {gyro.M[i][j], gyro.M_sd[i][j]};
            fitted["gyro K_" + row + axis_names[j]] = {gyro.K_s_per_m[i][j], gyro.K_sd_s_per_m[i][j]};
        }
    }
    return fitted;
}

// The share of sets in which a parameter lies within so many stated deviations: binomial, four of its own
// deviations off at most (6 in 100 000 of each of the 60 shares).
void expect_share(double within, double sets, double stated, const std::string& what) {
    EXPECT_NEAR(within / sets, stated, 4.0 * std::sqrt(stated * (1.0 - stated) / sets)) << what;
}

TEST(Coverage, ParametersLieWithinTheirStatedDeviationsAsOftenAsTheyShould) {
    constexpr std::uint64_t sets = 200;
    constexpr double turn_sd_rad = 2e-3;
    FaultySensor truth_sensor;
    truth_sensor.acc_noise_m_s2 = 0.004;
    truth_sensor.gyro_noise_rad_s = 0.002;
    const std::map<std::string, double> truth = truth_of(truth_sensor);
    std::map<std::string, double> within_one;
    std::map<std::string, double> within_two;
    const RandomStream errors(7, 1);
    CalibrationOptions options = with_turns(turn_sd_rad);
    options.observations.axis_sd_rad = 1e-4;  // the simulated axis is upright
    for (std::uint64_t set = 0; set < sets; ++set) {
        MovedSensor moved(truth_sensor, 1000 + set, 50.0);
        whole_session(moved, turn_sd_rad * errors.normal(set));
        const Calibration calibration = calibrate({moved.recording()}, options);
        ASSERT_TRUE(calibration.accelerometer.calibration && calibration.gyro.calibration) << set;
        for (const auto& [name, fitted] : fitted_of(calibration)) {
            const double error = std::abs(fitted.value - truth.at(name));
            within_one[name] += error < fitted.sd ? 1.0 : 0.0;
            within_two[name] += error < 2.0 * fitted.sd ? 1.0 : 0.0;
        }
    }
    EXPECT_EQ(within_one.size(), 30U);
    for (const auto& [name, count] : within_one) { expect_share(count, sets, 0.6827, name + " within one"); }
    for (const auto& [name, count] : within_two) { expect_share(count, sets, 0.9545, name + " within two"); }
}

TEST(Coverage, TemperatureCoefficientsLieWithinTheirStatedDeviationsAsOftenAsTheyShould) {
    constexpr std::uint64_t sets = 200;
    FaultySensor sensor;
    sensor.gyro_c = {2e-4, -4e-6, 2e-7};
    std::array<double, 3> within_one{};
    std::array<double, 3> within_two{};
    for (std::uint64_t set = 0; set < sets; ++set) {
        MovedSensor moved(sensor, 5000 + set, 20.0);
        moved.set_temperature_C(5.0);
        moved.warm(200.0, 45.0);
        const Calibration calibration = calibrate({moved.recording("ramp.csv", true)});
        ASSERT_TRUE(calibration.gyro_temperature.calibration);
        const TemperaturePolynomial& x = calibration.gyro_temperature.calibration->axes[0];
        ASSERT_EQ(x.order, 3U) << set;
        for (std::size_t k = 0; k < 3; ++k) {
            const double error = std::abs(x.c[k] - sensor.gyro_c[k]);
            within_one[k] += error < x.c_sd[k] ? 1.0 : 0.0;
            within_two[k] += error < 2.0 * x.c_sd[k] ? 1.0 : 0.0;
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        expect_share(within_one[k], sets, 0.6827, "c" + std::to_string(k + 1) + " within one");
        expect_share(within_two[k], sets, 0.9545, "c" + std::to_string(k + 1) + " within two");
    }
}

TEST(Calibration, RestsMayLieInSeveralRecordings) {
    const FaultySensor truth;
    MovedSensor one(truth, 31);
    rest_in(one, faces());
    MovedSensor other(truth, 32);
    rest_in(other, edges());
    const Calibration calibration = calibrate({one.recording("faces.csv"), other.recording("edges.csv")});
    ASSERT_TRUE(calibration.accelerometer.calibration);
    EXPECT_TRUE(calibration.accelerometer.calibration->has_misalignment);
    EXPECT_EQ(calibration.phases.rests.size(), 12U);
    EXPECT_EQ(calibration.phases.moves.size(), 10U) << "none leads from one recording into the other";
}

TEST(Calibration, OneRestDeterminesNothingAndSaysWhatToAdd) {
    MovedSensor moved({}, 33);
    moved.rest(10.0);
    const Calibration calibration = calibrate({moved.recording()});
    EXPECT_FALSE(calibration.determines_anything());
    ASSERT_EQ(calibration.undetermined.size(), 6U);  // accelerometer, K, three columns, temperature
    EXPECT_THAT(calibration.undetermined[0].add, HasSubstr("up"));
}

TEST(Calibration, AGyroWhoseAxesAreSwappedIsSaid) {
    MovedSensor moved({}, 36);
    whole_session(moved);
    Recording recording = moved.recording();
    std::swap(recording.columns[0].data, recording.columns[1].data);
    const Calibration calibration = calibrate({recording});
    EXPECT_THAT(calibration.warnings,
                testing::Contains(HasSubstr("are the sampling rate and the axes right?")));
    EXPECT_THAT(calibrate({moved.recording()}).warnings, testing::IsEmpty());
}

// A ramp that moves the bias does not spoil the pose fit: the temperature's part is taken out of the rests.
TEST(Calibration, RestsAreTakenToTheReferenceTemperature) {
    FaultySensor truth;
    truth.acc_c = {3e-3, 0.0, 0.0};
    truth.gyro_c = {4e-4, 0.0, 0.0};
    MovedSensor moved(truth, 34, 50.0);
    moved.set_temperature_C(15.0);
    moved.warm(100.0, 35.0);
    rest_in(moved, faces());
    rest_in(moved, edges());
    const Calibration calibration = calibrate({moved.recording("both.csv", true)});
    ASSERT_TRUE(calibration.accelerometer.calibration && calibration.gyro.calibration);
    EXPECT_EQ(calibration.gyro_temperature.calibration->reference_C, 25.0);
    EXPECT_NEAR(calibration.accelerometer.calibration->bias_m_s2[0], truth.acc_bias_m_s2[0], 5e-3);
    EXPECT_NEAR(calibration.gyro.calibration->bias_rad_s[0], truth.gyro_bias_rad_s[0], 2e-4);
}

TEST(CalibratedModel, HasWhatWasFittedAndCanBeSimulated) {
    FaultySensor truth;
    truth.gyro_c = {4e-4, 5e-6, 0.0};
    truth.acc_c = {3e-3, 0.0, 0.0};
    MovedSensor moved(truth, 35, 50.0);
    moved.set_temperature_C(10.0);
    moved.warm(100.0, 40.0);
    whole_session(moved);
    const Recording recording = moved.recording("all.csv", true);
    const Calibration calibration = calibrate({recording}, with_turns(1e-3));
    const SensorModel model = calibrated_model(calibration, recording);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    EXPECT_NEAR(model.M[0][0], truth.gyro_M[0][0], 0.01);
    EXPECT_NEAR(model.axes[1].bias_rad_s, truth.gyro_bias_rad_s[1], 1e-3);
    EXPECT_NEAR(model.axes[0].noise.N_rad_per_sqrt_s, 0.001 / std::sqrt(50.0), 4e-5);
    ASSERT_TRUE(model.accelerometer);
    EXPECT_NEAR(model.accelerometer->M[1][0], truth.acc_M[1][0], 0.002);
    std::map<std::string, EffectModel> of_x;
    for (const EffectModel& effect : model.effects) {
        if (effect.axes == std::vector<std::string>{"x"}) { of_x[effect.effect] = effect; }
    }
    ASSERT_TRUE(of_x.contains("temp_quadratic"));
    EXPECT_NEAR(of_x["temp_quadratic"].params["c1_dps_per_C"], 4e-4 * deg_per_rad, 1e-3);
    ASSERT_TRUE(of_x.contains("g_sensitivity"));
    EXPECT_NEAR(of_x["g_sensitivity"].params["x_dps_per_g"], 1e-4 * deg_per_rad * standard_gravity_m_s2,
                0.01);
    ASSERT_FALSE(model.accelerometer->effects.empty());
    EXPECT_TRUE(model.accelerometer->effects[0].params.contains("c1_g_per_C"));
}

}  // namespace
}  // namespace gyrolog
