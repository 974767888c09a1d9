#include "analysis/simulate/datasheet.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {
namespace {

Datasheet sheet() {
    Datasheet sheet;
    sheet.rate_hz = 1000.0;
    sheet.full_scale_rad_s = 10.0;
    sheet.lsb_rad_s = 1e-4;
    sheet.N_rad_per_sqrt_s = 1e-4;
    sheet.zero_rate_rad_s = 0.1;
    sheet.zero_rate_over_temperature_rad_s = 0.65;
    sheet.temperature_from_C = -40.0;
    sheet.temperature_to_C = 85.0;
    sheet.scale = 0.03;
    sheet.scale_over_temperature = 0.04;
    sheet.cross_axis = 0.02;
    sheet.nonlinearity = 0.001;
    sheet.rate = 0.01;
    return sheet;
}

TEST(Datasheet, TheSameSeedDrawsTheSameUnitAndAnotherAnotherOne) {
    EXPECT_EQ(draw_unit(sheet(), 3).model.M, draw_unit(sheet(), 3).model.M);
    EXPECT_NE(draw_unit(sheet(), 3).model.axes[0].bias_rad_s, draw_unit(sheet(), 4).model.axes[0].bias_rad_s);
}

TEST(Datasheet, AnotherParameterLeavesTheDrawsOfTheOthersAlone) {
    Datasheet less = sheet();
    less.scale.reset();
    less.nonlinearity.reset();
    EXPECT_EQ(draw_unit(less, 3).model.axes[1].bias_rad_s, draw_unit(sheet(), 3).model.axes[1].bias_rad_s);
    EXPECT_EQ(draw_unit(less, 3).model.M[0][1], draw_unit(sheet(), 3).model.M[0][1]);
    EXPECT_EQ(draw_unit(less, 3).model.M[0][0], 1.0);
}

TEST(Datasheet, UnitsFillTheRectangleBetweenTheLimitsAndNeverLeaveIt) {
    constexpr int units = 2000;
    std::array<int, 10> bins{};
    double scale_squares = 0.0;
    double cross_squares = 0.0;
    for (unsigned seed = 0; seed < units; ++seed) {
        const SensorModel unit = draw_unit(sheet(), seed).model;
        for (const AxisModel& axis : unit.axes) { ASSERT_LE(std::fabs(axis.bias_rad_s), 0.1); }
        bins[std::min<std::size_t>(9, static_cast<std::size_t>((unit.axes[0].bias_rad_s + 0.1) / 0.02))]++;
        scale_squares += std::pow(unit.M[2][2] - 1.0, 2.0);
        cross_squares += std::pow(unit.M[2][1], 2.0);
        ASSERT_LE(std::fabs(unit.M[2][2] - 1.0), 0.03);
        // At -40 degC, 65 K from the reference, the whole tolerance may be used up, and not more.
        ASSERT_LE(65.0 * std::fabs(unit.temperature->bias_rad_s_per_C[1]), 0.65 + 1e-12);
        ASSERT_LE(65.0 * std::fabs(unit.temperature->scale_per_C[1]), 0.04 + 1e-12);
    }
    double chi_square = 0.0;
    for (const int count : bins) { chi_square += std::pow(count - units / 10.0, 2.0) / (units / 10.0); }
    EXPECT_LT(chi_square, 27.9);  // 99.9 % of chi-square with 9 degrees of freedom
    // The variance of a rectangle of half-width a is a^2 / 3; that of its square 4 a^4 / 45.
    const double allowed = 4.0 * std::sqrt(4.0 / 45.0 / units);
    EXPECT_NEAR(scale_squares / units / (0.03 * 0.03), 1.0 / 3.0, allowed);
    EXPECT_NEAR(cross_squares / units / (0.02 * 0.02), 1.0 / 3.0, allowed);
}

TEST(Datasheet, TheModelKnowsItsUnitToTheStandardUncertaintyOfTheTolerance) {
    const SensorModel unit = draw_unit(sheet(), 1).model;
    EXPECT_DOUBLE_EQ(unit.sd_abs.at("M"), 0.03 / std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(unit.sd_abs.at("rate_rel"), 0.01 / std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(unit.sd_abs.at("bias_dps"), 0.1 * deg_per_rad / std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(unit.sd_abs.at("scale_percent_per_C"), 4.0 / 65.0 / std::sqrt(3.0));
    EXPECT_EQ(unit.saturation_rad_s, 32767.0 * 1e-4);
}

TEST(Datasheet, NonlinearityStaysWithinItsToleranceAtFullScale) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const SensorModel unit = draw_unit(sheet(), seed).model;
        EXPECT_EQ(simulation_refusal(unit), std::nullopt);
        for (const EffectModel& effect : unit.effects) {
            if (effect.effect != "nonlinearity") { continue; }
            EXPECT_LE(std::fabs(effect.params.at("quadratic")) + std::fabs(effect.params.at("cubic")), 0.001);
        }
    }
}

TEST(Datasheet, WhatItDoesNotGiveIsSaid) {
    Datasheet bare;
    bare.rate_hz = 100.0;
    bare.full_scale_rad_s = 10.0;
    const DrawnUnit unit = draw_unit(bare, 1);
    EXPECT_EQ(unit.model.M, identity_matrix);
    EXPECT_EQ(unit.model.saturation_rad_s, 10.0);
    EXPECT_TRUE(unit.model.effects.empty());
    EXPECT_TRUE(unit.model.sd_abs.empty());
    ASSERT_EQ(unit.notes.size(), 1U);
    EXPECT_EQ(unit.notes[0].substr(0, 57), "not in the data sheet, so not simulated: bias instability");
}

}  // namespace
}  // namespace gyrolog
