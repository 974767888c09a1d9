// The effects on the answer to motion, acceleration and temperature.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double peak_rad_s = 300.0 * rad_per_deg;

// The residual after the true rate of the axis itself.
std::vector<double> residual(const Simulated& run, std::size_t axis) {
    std::vector<double> out(run.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = run.rate_rad_s[axis][i] - run.true_rate_rad_s[axis][i];
    }
    return out;
}

struct Line {
    double slope;
    double slope_sd;
    double intercept;
};

Line fit_line(const std::vector<double>& x, const std::vector<double>& y, double y_sd) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    const double slope = xy / xx;
    return {slope, y_sd / std::sqrt(xx), mean_y - slope * mean_x};
}

// Every seed's slope within its scatter, and all together: their squares add up to chi-square.
template <typename Slope>
void expect_slope(const SensorModel& model, const std::shared_ptr<FormulaWorld>& world, double expected,
                  Slope slope_of) {
    constexpr int seeds = 30;
    double sum = 0.0;
    double squares = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Line line = slope_of(simulate(model, 100.0, static_cast<std::uint64_t>(seed), 4, world));
        const double z = (line.slope - expected) / line.slope_sd;
        sum += z;
        squares += z * z;
    }
    EXPECT_LT(std::fabs(sum), 4.0 * std::sqrt(seeds));
    EXPECT_LT(squares, chi_square_limit(seeds));
}

constexpr double N = 0.01 * rad_per_deg;
constexpr double white_sd = 10.0 * N;  // at 100 Hz

TEST(ScaleFactor, ItsErrorIsTheSlopeOfTheResidualOverTheTrueRate) {
    const SensorModel model = with_effect(white_model(N), "scale_factor", {{"eps", 2e-4}}, {"y"});
    expect_slope(model, tumbling_world(peak_rad_s), 2e-4, [](const Simulated& run) {
        return fit_line(run.true_rate_rad_s[1], residual(run, 1), white_sd);
    });
}

TEST(ScaleFactor, LeavesBiasAndNoiseAlone) {
    SensorModel plain = white_model(N);
    plain.axes[0].bias_rad_s = 0.2;
    const SensorModel scaled = with_effect(plain, "scale_factor", {{"eps", 0.5}});
    EXPECT_EQ(simulate(plain, 100.0, 1, 2).rate_rad_s[0], simulate(scaled, 100.0, 1, 2).rate_rad_s[0]);
}

TEST(Misalignment, ItsGainIsTheSlopeOfTheResidualOverTheOtherAxis) {
    const SensorModel model = with_effect(white_model(N), "misalignment", {{"from_z", -3e-4}}, {"x"});
    auto world = tumbling_world(peak_rad_s);
    world->rate_rad_s = [](double t_s) { return Vector3{0.0, 0.0, peak_rad_s * triangle(t_s / 3.7)}; };
    expect_slope(model, world, -3e-4, [](const Simulated& run) {
        return fit_line(run.true_rate_rad_s[2], run.rate_rad_s[0], white_sd);
    });
}

TEST(Misalignment, GivesEachNamedAxisTheTrueRatesOfTheOthersOnly) {
    const SensorModel model = with_effect(
        ideal_model(), "misalignment", {{"from_x", 0.01}, {"from_y", 0.02}, {"from_z", -0.03}}, {"x", "y"});
    const Simulated run = simulate(model, 100.0, 1, 1, tumbling_world(peak_rad_s));
    const auto& w = run.true_rate_rad_s;
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.rate_rad_s[0][i], w[0][i] + 0.02 * w[1][i] - 0.03 * w[2][i], 1e-14);
        ASSERT_NEAR(run.rate_rad_s[1][i], w[1][i] + 0.01 * w[0][i] - 0.03 * w[2][i], 1e-14);
        ASSERT_EQ(run.rate_rad_s[2][i], w[2][i]);
    }
}

// The rates of a static calibration: plateaus of both signs.
Simulated plateaus(const SensorModel& model, const std::vector<double>& plateaus_rad_s) {
    const auto world = world_turning([&](double t_s) {
        const auto place = static_cast<std::size_t>(t_s) % plateaus_rad_s.size();
        return Vector3{plateaus_rad_s[place], 0.0, 0.0};
    });
    return simulate(model, 1.0, 1, 1, world);
}

TEST(Nonlinearity, ItsFractionsAreTheErrorsAtFullScale) {
    const double full_scale = 500.0 * rad_per_deg;
    const SensorModel model =
        with_effect(ideal_model(), "nonlinearity", {{"quadratic", 1e-3}, {"cubic", -4e-3}});
    const Simulated run = plateaus(model, {full_scale, -full_scale, 0.5 * full_scale, 0.0});
    EXPECT_NEAR(run.rate_rad_s[0][0] / full_scale, 1.0 + 1e-3 - 4e-3, 1e-14);
    EXPECT_NEAR(run.rate_rad_s[0][1] / full_scale, -1.0 + 1e-3 + 4e-3, 1e-14);
    EXPECT_NEAR(run.rate_rad_s[0][2] / full_scale, 0.5 + 0.25e-3 - 0.5e-3, 1e-14);
    EXPECT_EQ(run.rate_rad_s[0][3], 0.0);
}

TEST(Asymmetry, IsHalfTheDifferenceOfTheTwoDirectionsGains) {
    const SensorModel model = with_effect(ideal_model(), "asymmetry", {{"gain", 5e-3}});
    const Simulated run = plateaus(model, {2.0, -2.0});
    EXPECT_NEAR((run.rate_rad_s[0][0] / 2.0 - run.rate_rad_s[0][1] / -2.0) / 2.0, 5e-3, 1e-15);
    EXPECT_NEAR((run.rate_rad_s[0][0] / 2.0 + run.rate_rad_s[0][1] / -2.0) / 2.0, 1.0, 1e-15);
}

TEST(DeadZone, AnswersNothingInsideAndLessTheWidthOutside) {
    const SensorModel model = with_effect(ideal_model(), "dead_zone", {{"width_dps", 1.0}});
    const double dps = rad_per_deg;
    const Simulated run = plateaus(model, {0.99 * dps, -0.99 * dps, 1.5 * dps, -1.5 * dps});
    EXPECT_EQ(run.rate_rad_s[0][0], 0.0);
    EXPECT_EQ(run.rate_rad_s[0][1], 0.0);
    EXPECT_NEAR(run.rate_rad_s[0][2], 0.5 * dps, 1e-15);
    EXPECT_NEAR(run.rate_rad_s[0][3], -0.5 * dps, 1e-15);
}

TEST(DeadZone, OfTheJumpingKindAnswersInFullOutside) {
    const SensorModel model = with_effect(ideal_model(), "dead_zone", {{"width_dps", 1.0}, {"jump", 1.0}});
    const double dps = rad_per_deg;
    const Simulated run = plateaus(model, {0.99 * dps, 1.01 * dps, -1.01 * dps});
    EXPECT_EQ(run.rate_rad_s[0][0], 0.0);
    EXPECT_EQ(run.rate_rad_s[0][1], 1.01 * dps);
    EXPECT_EQ(run.rate_rad_s[0][2], -1.01 * dps);
}

TEST(GSensitivity, IsTheSlopeOfTheRateOverTheSpecificForce) {
    const SensorModel model = with_effect(white_model(N), "g_sensitivity", {{"y_dps_per_g", 0.1}}, {"x"});
    auto world = world_turning([](double) { return Vector3{}; });
    world->specific_force_m_s2 = [](double t_s) {
        return Vector3{0.0, standard_gravity_m_s2 * triangle(t_s / 3.0), 0.0};
    };
    expect_slope(model, world, 0.1 * rad_per_deg / standard_gravity_m_s2, [](const Simulated& run) {
        return fit_line(run.force_m_s2[1], run.rate_rad_s[0], white_sd);
    });
}

TEST(GSensitivity, ShowsInAStaticTiltToo) {
    SensorModel model = with_effect(ideal_model(), "g_sensitivity",
                                    {{"x_dps_per_g", 0.1}, {"y_dps_per_g", 0.2}, {"z_dps_per_g", 0.3}});
    EXPECT_NEAR(simulate(model, 100.0, 1, 1).rate_rad_s[0][5], 0.3 * rad_per_deg, 1e-15);
    model.orientation = Matrix3{{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};  // its x axis upward
    EXPECT_NEAR(simulate(model, 100.0, 1, 1).rate_rad_s[0][5], 0.1 * rad_per_deg, 1e-15);
}

TEST(VibrationRectification, IsABiasByTheMeanSquareOfTheVibrationAndNoneAtRest) {
    const SensorModel model = with_effect(ideal_model(), "vibration_rectification", {{"z_dps_per_g2", 0.02}});
    const Simulated at_rest = simulate(model, 100.0, 1, 1);
    for (const double rate : at_rest.rate_rad_s[0]) { ASSERT_NEAR(rate, 0.0, 1e-18); }

    constexpr double amplitude_g = 3.0;
    auto world = world_turning([](double) { return Vector3{}; });
    world->specific_force_m_s2 = [](double t_s) {
        return Vector3{0.0, 0.0,
                       standard_gravity_m_s2 * (1.0 + amplitude_g * std::sin(2.0 * pi * t_s / 8.0))};
    };
    const Simulated run = simulate(model, 1.0, 1, 1, world);  // 128 whole periods
    const double mean = std::accumulate(run.rate_rad_s[0].begin(), run.rate_rad_s[0].end(), 0.0) /
                        static_cast<double>(run.size());
    EXPECT_NEAR(mean, 0.02 * rad_per_deg * amplitude_g * amplitude_g / 2.0, 1e-12);
}

std::shared_ptr<FormulaWorld> warming_world() {
    auto world = world_turning([](double) { return Vector3{1.0, 2.0, 3.0}; });
    world->temperature_C = [](double t_s) { return 20.0 + t_s; };
    return world;
}

TEST(TemperatureScale, MultipliesAllThatTheSensorShowsAboutItsReference) {
    SensorModel model = ideal_model();
    model.axes[0].bias_rad_s = 0.5;
    model.effects = {effect_entry("temp_scale", {{"per_C", 1e-3}}, {"x"})};
    const Simulated run = simulate(model, 1.0, 1, 1, warming_world());
    EXPECT_NEAR(run.rate_rad_s[0][5], 1.5, 1e-15);
    EXPECT_NEAR(run.rate_rad_s[0][105], 1.5 * 1.1, 1e-14);
    EXPECT_EQ(run.rate_rad_s[1][105], 2.0);
}

// A published block: MathWorks' gyroparams, whose imuSensor computes
//   (G w + bias + (T - 25) TemperatureBias + noise) (1 + TemperatureScaleFactor / 100 (T - 25)),
// where the vector AxesMisalignment [a b c] makes G = [100 b c; a 100 c; a b 100] / 100.
TEST(PublishedBlock, GivesWhatItsOwnSimulatorComputes) {
    SensorModel model = ideal_model();
    model.misalignment = Vector3{0.01, 0.02, 0.03};
    model.temperature = TemperatureModel{
        .reference_C = 25.0, .bias_rad_s_per_C = {0.001, -0.002, 0.003}, .scale_per_C = {2e-4, 3e-4, -4e-4}};
    for (AxisModel& axis : model.axes) { axis.bias_rad_s = 0.3; }
    const Simulated run = simulate(model, 1.0, 1, 1, warming_world());
    const Vector3 turned = {1.0 + 0.02 * 2.0 + 0.03 * 3.0, 0.01 * 1.0 + 2.0 + 0.03 * 3.0,
                            0.01 * 1.0 + 0.02 * 2.0 + 3.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double above_C = 35.0;  // at sample 40
        const double expected = (turned[axis] + 0.3 + above_C * model.temperature->bias_rad_s_per_C[axis]) *
                                (1.0 + above_C * model.temperature->scale_per_C[axis]);
        EXPECT_NEAR(run.rate_rad_s[axis][40], expected, 1e-14);
    }
}

}  // namespace
}  // namespace gyrolog
