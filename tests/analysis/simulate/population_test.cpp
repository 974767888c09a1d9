#include "analysis/simulate/population.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {
namespace {

Population population() {
    Population all;
    all.rate_hz = UnitSpread{200.0, 0.2};
    for (AxisPopulation& axis : all.axes) {
        axis.bias_rad_s = UnitSpread{0.01, 0.05};
        axis.N_rad_per_sqrt_s = UnitSpread{1e-4, 3e-5};
        axis.B_rad_per_s = UnitSpread{3e-5, 0.0};
    }
    return all;
}

TEST(Population, TheSameSeedDrawsTheSameUnitAndAParameterMoreLeavesTheOthersAlone) {
    Population more = population();
    more.axes[1].K_rad_per_s_sqrt_s = UnitSpread{1e-6, 1e-7};
    const SensorModel one = draw_unit(population(), 3).model;
    const SensorModel same = draw_unit(more, 3).model;
    EXPECT_EQ(one.axes[1].bias_rad_s, same.axes[1].bias_rad_s);
    EXPECT_EQ(one.axes[1].noise.N_rad_per_sqrt_s, same.axes[1].noise.N_rad_per_sqrt_s);
    EXPECT_NE(one.axes[1].bias_rad_s, one.axes[2].bias_rad_s);
    EXPECT_NE(one.axes[1].bias_rad_s, draw_unit(population(), 4).model.axes[1].bias_rad_s);
    EXPECT_EQ(one.axes[0].noise.B_rad_per_s, 3e-5) << "without a spread it is the median";
}

TEST(Population, UnitsHaveItsMeansAndDeviationsAndNoNoiseIsNegative) {
    constexpr int units = 4000;
    double bias = 0.0;
    double bias_squares = 0.0;
    double log_N = 0.0;
    double log_N_squares = 0.0;
    double rate_squares = 0.0;
    for (unsigned seed = 0; seed < units; ++seed) {
        const SensorModel unit = draw_unit(population(), seed).model;
        const double off = (unit.axes[2].bias_rad_s - 0.01) / 0.05;
        bias += off;
        bias_squares += off * off;
        ASSERT_GT(unit.axes[0].noise.N_rad_per_sqrt_s, 0.0);
        const double log_off = std::log(unit.axes[0].noise.N_rad_per_sqrt_s / 1e-4) / 0.3;
        log_N += log_off;
        log_N_squares += log_off * log_off;
        rate_squares += std::pow(unit.effects.front().params.at("rel") / 1e-3, 2.0);
        ASSERT_EQ(unit.rate_hz, 200.0);
    }
    // Four standard deviations of a mean, and of a mean square, of so many.
    const double of_mean = 4.0 / std::sqrt(units);
    const double of_square = 4.0 * std::sqrt(2.0 / units);
    EXPECT_NEAR(bias / units, 0.0, of_mean);
    EXPECT_NEAR(log_N / units, 0.0, of_mean);
    EXPECT_NEAR(bias_squares / units, 1.0, of_square);
    EXPECT_NEAR(log_N_squares / units, 1.0, of_square);
    EXPECT_NEAR(rate_squares / units, 1.0, of_square);
}

TEST(Population, AUnitSaysHowWellItIsKnownAndWhatItLacks) {
    const DrawnUnit unit = draw_unit(population(), 1);
    EXPECT_DOUBLE_EQ(unit.model.sd_abs.at("bias_dps"), 0.05 * deg_per_rad);
    EXPECT_DOUBLE_EQ(unit.model.sd_abs.at("rate_rel"), 1e-3);
    EXPECT_DOUBLE_EQ(unit.model.axes[1].sd_rel.at("N"), 0.3);
    EXPECT_EQ(simulation_refusal(unit.model), std::nullopt);
    ASSERT_EQ(unit.notes.size(), 1U);
    EXPECT_EQ(unit.notes[0],
              "not in the population, so not simulated: K of x, K of y, K of z, range, resolution");
}

}  // namespace
}  // namespace gyrolog
