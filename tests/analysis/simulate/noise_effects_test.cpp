// The effects on noise and those of the temperature, sample by sample: one seed, no statistics.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

std::shared_ptr<FormulaWorld> world_at(std::function<double(double)> temperature_C) {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = std::move(temperature_C);
    return world;
}

// Between 15 and 35 degC, a period of 40 s.
std::shared_ptr<FormulaWorld> waving_world() {
    return world_at([](double t_s) { return 25.0 + 10.0 * std::sin(2.0 * pi * t_s / 40.0); });
}

using Gain = std::function<double(std::size_t)>;

// The model's last effect multiplies what the model gives without it.
void expect_gain(const SensorModel& model, const Gain& gain,
                 const std::shared_ptr<const World>& world = nullptr) {
    SensorModel without = model;
    without.effects.pop_back();
    const Simulated changed = simulate(model, rate_hz, 3, 5, world);
    const Simulated plain = simulate(without, rate_hz, 3, 5, world);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        ASSERT_NEAR(changed.rate_rad_s[0][i], gain(i) * plain.rate_rad_s[0][i], 1e-14) << i;
        ASSERT_EQ(changed.rate_rad_s[1][i], plain.rate_rad_s[1][i]) << i;
    }
}

TEST(WhiteNoiseEffects, ArwScaleMultipliesTheWhiteNoise) {
    expect_gain(with_effect(white_model(0.02), "arw_scale", {{"factor", 1.7}}, {"x"}),
                [](std::size_t) { return 1.7; });
}

TEST(WhiteNoiseEffects, AVarianceChangeIsAStepUnlessItHasARamp) {
    expect_gain(with_effect(white_model(0.02), "variance_change", {{"factor", 3.0}, {"at_s", 12.0}}, {"x"}),
                [](std::size_t i) { return i < 1200 ? 1.0 : 3.0; });
    expect_gain(with_effect(white_model(0.02), "variance_change",
                            {{"factor", 3.0}, {"at_s", 12.0}, {"ramp_s", 20.0}}, {"x"}),
                [](std::size_t i) {
                    return std::clamp(1.0 + 2.0 * (static_cast<double>(i) / 100.0 - 12.0) / 20.0, 1.0, 3.0);
                });
}

TEST(WhiteNoiseEffects, TempNoiseFollowsTheTemperatureDownToATwentieth) {
    const auto gain = [](double per_C, double reference_C) {
        return [=](std::size_t i) {
            const double C = 25.0 + 10.0 * std::sin(2.0 * pi * static_cast<double>(i) / 4000.0);
            return std::max(0.05, 1.0 + per_C * (C - reference_C));
        };
    };
    SensorModel model = white_model(0.02);
    expect_gain(with_effect(model, "temp_noise", {{"per_C", 0.02}}, {"x"}), gain(0.02, 25.0), waving_world());
    model.temperature = TemperatureModel{.reference_C = 30.0, .bias_rad_s_per_C = {}, .scale_per_C = {}};
    expect_gain(with_effect(model, "temp_noise", {{"per_C", 0.02}}, {"x"}), gain(0.02, 30.0), waving_world());
    expect_gain(with_effect(model, "temp_noise", {{"per_C", -0.5}, {"reference_C", 20.0}}, {"x"}),
                gain(-0.5, 20.0), waving_world());
}

TEST(WhiteNoiseEffects, ScaleAlsoWhatHasHeavyTails) {
    const SensorModel heavy = with_effect(white_model(0.02), "heavy_tail", {{"nu", 4.0}});
    expect_gain(with_effect(heavy, "arw_scale", {{"factor", 0.5}}, {"x"}), [](std::size_t) { return 0.5; });
}

TEST(WhiteNoiseEffects, LeaveTheSlowNoiseAlone) {
    SensorModel model = ideal_model();
    for (AxisModel& axis : model.axes) {
        axis.noise.B_rad_per_s = 0.1;
        axis.noise.K_rad_per_s_sqrt_s = 0.1;
    }
    expect_gain(with_effect(model, "arw_scale", {{"factor", 5.0}}, {"x"}), [](std::size_t) { return 1.0; });
}

TEST(CommonMode, ReachesTheNamedAxesInProportionToTheirGains) {
    const SensorModel model =
        with_effect(ideal_model(), "common_mode",
                    {{"N_dps_per_sqrt_hz", 0.01}, {"gain_x", 0.5}, {"gain_z", -0.8}}, {"x", "z"});
    const Simulated out = simulate(model, rate_hz, 3, 1);
    for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_NE(out.rate_rad_s[0][i], 0.0);
        ASSERT_EQ(out.rate_rad_s[1][i], 0.0);
        ASSERT_NEAR(out.rate_rad_s[2][i], -1.6 * out.rate_rad_s[0][i], 1e-15);
    }
}

// The axis has as much white noise as before.
TEST(CommonMode, ThatIsPartOfTheWhiteNoiseTakesItsPlace) {
    const SensorModel own = white_model(0.01 * rad_per_deg);
    const double share = 0.6;
    const SensorModel model = with_effect(
        own, "common_mode",
        {{"N_dps_per_sqrt_hz", 0.01 * std::sqrt(share)}, {"gain_y", -1.0}, {"part_of_white", 1.0}},
        {"x", "y"});
    const Simulated out = simulate(model, rate_hz, 7, 40);
    double both = 0.0;
    double squares_x = 0.0;
    double squares_y = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        both += out.rate_rad_s[0][i] * out.rate_rad_s[1][i];
        squares_x += out.rate_rad_s[0][i] * out.rate_rad_s[0][i];
        squares_y += out.rate_rad_s[1][i] * out.rate_rad_s[1][i];
    }
    const auto count = static_cast<double>(out.size());
    const double variance = 0.01 * 0.01 * rad_per_deg * rad_per_deg * rate_hz;
    const double sigmas = 5.0 * std::sqrt(2.0 / count);
    EXPECT_NEAR(squares_x / count / variance, 1.0, sigmas);
    EXPECT_NEAR(squares_y / count / variance, 1.0, sigmas);
    EXPECT_NEAR(both / count / variance, -share, sigmas);
}

TEST(Telegraph, HasTwoLevelsHalfItsAmplitudeFromZero) {
    const SensorModel model = with_effect(
        ideal_model(), "rtn", {{"amplitude_dps", 0.2}, {"dwell_high_s", 0.1}, {"dwell_low_s", 0.3}}, {"y"});
    const Simulated out = simulate(model, rate_hz, 3, 4);
    const double half_rad_s = 0.1 * rad_per_deg;
    for (const double rate_rad_s : out.rate_rad_s[1]) { ASSERT_EQ(std::fabs(rate_rad_s), half_rad_s); }
    EXPECT_NE(std::ranges::count(out.rate_rad_s[1], half_rad_s), 0);
    EXPECT_NE(std::ranges::count(out.rate_rad_s[1], -half_rad_s), 0);
}

TEST(HeavyTail, TheDegreesOfFreedomMustLeaveAVariance) {
    EXPECT_EQ(simulation_refusal(with_effect(ideal_model(), "heavy_tail", {{"nu", 2.0}})),
              "effect 'heavy_tail': nu is not above two");
    EXPECT_EQ(simulation_refusal(with_effect(ideal_model(), "heavy_tail", {{"nu", 2.1}})), std::nullopt);
}

using Bias = std::function<double(std::size_t)>;

void expect_bias(const SensorModel& model, double tolerance_dps, const Bias& bias_dps,
                 std::shared_ptr<const World> world = nullptr) {
    const Simulated out = simulate(model, rate_hz, 3, 10, std::move(world));
    for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_NEAR(out.rate_rad_s[0][i] * deg_per_rad, bias_dps(i), tolerance_dps) << i;
        ASSERT_EQ(out.rate_rad_s[1][i], 0.0) << i;
    }
}

double wave_C(std::size_t i) { return 25.0 + 10.0 * std::sin(2.0 * pi * static_cast<double>(i) / 4000.0); }

TEST(TemperatureEffects, TheBiasFollowsALineOrAParabolaAboutTheReference) {
    expect_bias(
        with_effect(ideal_model(), "temp_linear", {{"c1_dps_per_C", 0.03}}, {"x"}), 1e-13,
        [](std::size_t i) { return 0.03 * (wave_C(i) - 25.0); }, waving_world());
    expect_bias(
        with_effect(ideal_model(), "temp_quadratic",
                    {{"c1_dps_per_C", 0.03}, {"c2_dps_per_C2", -0.002}, {"reference_C", 22.0}}, {"x"}),
        1e-13,
        [](std::size_t i) {
            const double above_C = wave_C(i) - 22.0;
            return 0.03 * above_C - 0.002 * above_C * above_C;
        },
        waving_world());
}

TEST(TemperatureEffects, TheBiasFollowsACubicAboutTheReference) {
    expect_bias(
        with_effect(ideal_model(), "temp_cubic",
                    {{"c1_dps_per_C", 0.03},
                     {"c2_dps_per_C2", -0.002},
                     {"c3_dps_per_C3", 0.0004},
                     {"reference_C", 22.0}},
                    {"x"}),
        1e-13,
        [](std::size_t i) {
            const double above_C = wave_C(i) - 22.0;
            return 0.03 * above_C - 0.002 * above_C * above_C + 0.0004 * above_C * above_C * above_C;
        },
        waving_world());
    // The lower orders are none unless given.
    expect_bias(
        with_effect(ideal_model(), "temp_cubic", {{"c3_dps_per_C3", 0.0004}}, {"x"}), 1e-13,
        [](std::size_t i) { return 0.0004 * std::pow(wave_C(i) - 25.0, 3.0); }, waving_world());
}

TEST(TemperatureEffects, WithoutAReferenceTheModelsOwnCounts) {
    SensorModel model = ideal_model();
    model.temperature = TemperatureModel{.reference_C = 31.0, .bias_rad_s_per_C = {}, .scale_per_C = {}};
    expect_bias(
        with_effect(model, "temp_linear", {{"c1_dps_per_C", 0.03}}, {"x"}), 1e-13,
        [](std::size_t i) { return 0.03 * (wave_C(i) - 31.0); }, waving_world());
}

TEST(TemperatureEffects, ALateBiasTrailsARampByItsTimeConstant) {
    // Settled at first; then u = T - slope tau (1 - exp(-t / tau)), exact for a straight line.
    expect_bias(
        with_effect(ideal_model(), "temp_lag", {{"c1_dps_per_C", 0.1}, {"tau_s", 12.0}}, {"x"}), 1e-12,
        [](std::size_t i) {
            const double t_s = static_cast<double>(i) / rate_hz;
            return 0.1 * (0.05 * t_s - 0.05 * 12.0 * (1.0 - std::exp(-t_s / 12.0)) - 3.0);
        },
        world_at([](double t_s) { return 22.0 + 0.05 * t_s; }));
}

TEST(TemperatureEffects, ALateBiasFollowsAWaveByTheTransferFunctionOfTheLag) {
    const double tau_s = 300.0;
    const Simulated out = simulate(
        with_effect(ideal_model(), "temp_lag", {{"c1_dps_per_C", 1.0}, {"tau_s", tau_s}}, {"x"}), 1.0, 3, 8,
        world_at([](double t_s) { return 25.0 + 10.0 * std::sin(2.0 * pi * t_s / 1200.0); }));
    const double w = 2.0 * pi / 1200.0 * tau_s;
    for (std::size_t i = 5000; i < out.size(); ++i) {
        const double phase = 2.0 * pi * static_cast<double>(i) / 1200.0 - std::atan(w);
        // The transient has decayed by 16 time constants; straight lines cut a wave's corners by 2e-6 of it.
        ASSERT_NEAR(out.rate_rad_s[0][i] * deg_per_rad, 10.0 * std::sin(phase) / std::sqrt(1.0 + w * w),
                    2e-4);
    }
}

TEST(TemperatureEffects, PlayMakesALoopOfItsWidthAndOfTheAreaThatFollows) {
    const double play_C = 3.0;
    const double half_swing_C = 10.0;
    const Simulated out = simulate(
        with_effect(ideal_model(), "temp_lag", {{"c1_dps_per_C", 0.2}, {"play_C", play_C}}, {"x"}), rate_hz,
        3, 8, world_at([&](double t_s) { return 25.0 + half_swing_C * triangle(t_s / 20.0); }));
    double area = 0.0;  // of one whole loop, after the first quarter
    for (std::size_t i = 2000; i < 4000; ++i) {
        const double step_C = out.die_C[i + 1] - out.die_C[i];
        area += 0.5 * (out.rate_rad_s[0][i] + out.rate_rad_s[0][i + 1]) * deg_per_rad * step_C;
    }
    EXPECT_NEAR(std::fabs(area), 0.2 * play_C * (2.0 * half_swing_C - play_C), 0.01);
    // Going up at the reference it trails by half the width, going down it is ahead by as much.
    EXPECT_NEAR(out.rate_rad_s[0][2000] * deg_per_rad, -0.2 * 0.5 * play_C, 1e-9);
    EXPECT_NEAR(out.rate_rad_s[0][3000] * deg_per_rad, 0.2 * 0.5 * play_C, 1e-9);
    EXPECT_EQ(out.rate_rad_s[0][0], 0.0);
}

TEST(WarmUp, DecaysExponentiallyToNothing) {
    expect_bias(with_effect(ideal_model(), "warmup", {{"a_dps", -0.7}, {"tau_s", 4.0}}, {"x"}), 1e-13,
                [](std::size_t i) { return -0.7 * std::exp(-static_cast<double>(i) / 400.0); });
    // 10^6 time constants on, all is over.
    const Simulated late = simulate(
        with_effect(ideal_model(), "warmup", {{"a_dps", 1.0}, {"tau_s", 1e-5}}, {"x"}), rate_hz, 3, 1);
    EXPECT_LT(late.rate_rad_s[0].back(), 1e-290);
}

TEST(SelfHeating, IsReportedAndActsOnTheBias) {
    const auto world = world_at([](double) { return 25.0; });
    const SensorModel model =
        with_effect(with_effect(ideal_model(), "self_heating", {{"rise_C", 6.0}, {"tau_s", 20.0}}),
                    "temp_linear", {{"c1_dps_per_C", 0.1}}, {"x"});
    const Simulated out = simulate(model, rate_hz, 3, 10, world);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double rise_C = 6.0 * (1.0 - std::exp(-static_cast<double>(i) / 2000.0));
        ASSERT_NEAR(out.temperature_C[i], 25.0 + rise_C, 1e-12);
        ASSERT_NEAR(out.rate_rad_s[0][i] * deg_per_rad, 0.1 * rise_C, 1e-12);
    }
}

const std::vector<EffectModel>& noise_effects() {
    static const std::vector<EffectModel> all = {
        effect_entry("flicker_missing", {{"B_dps", 0.002}}),
        effect_entry("rrw_missing", {{"K_dps_sqrt_hz", 1e-3}}),
        effect_entry("angle_noise", {{"Q_dps_s", 1e-4}}),
        effect_entry("rtn", {{"amplitude_dps", 0.02}, {"dwell_high_s", 0.5}, {"dwell_low_s", 1.0}}),
        effect_entry("heavy_tail", {{"nu", 3.5}}),
        effect_entry("arw_scale", {{"factor", 1.3}}),
        effect_entry("variance_change", {{"factor", 1.5}, {"at_s", 5.0}, {"ramp_s", 10.0}}),
        effect_entry("temp_noise", {{"per_C", 0.02}}),
        effect_entry("common_mode", {{"N_dps_per_sqrt_hz", 0.004}}),
        effect_entry("temp_linear", {{"c1_dps_per_C", 0.02}}),
        effect_entry("temp_quadratic", {{"c2_dps_per_C2", 0.01}}),
        effect_entry("temp_cubic", {{"c3_dps_per_C3", 0.001}}),
        effect_entry("temp_lag", {{"c1_dps_per_C", 0.1}, {"tau_s", 3.0}, {"play_C", 0.001}}),
        effect_entry("warmup", {{"a_dps", 0.3}, {"tau_s", 10.0}}),
        effect_entry("noise_colour", {{"gain", 0.4}, {"middle_of_rate", 0.2}}),
        effect_entry("narrowband", {{"f_hz", 31.0}, {"width_hz", 2.0}, {"sigma_dps", 0.02}}),
    };
    return all;
}

TEST(NoiseEffects, ActOnTheirAxisAndOnNoOther) {
    const Simulated plain = simulate(white_model(1e-4), rate_hz, 5, 2);
    for (EffectModel effect : noise_effects()) {
        effect.axes = {"y"};
        SensorModel model = white_model(1e-4);
        model.effects = {effect};
        const Simulated out = simulate(model, rate_hz, 5, 2);
        EXPECT_EQ(out.rate_rad_s[0], plain.rate_rad_s[0]) << effect.effect;
        EXPECT_NE(out.rate_rad_s[1], plain.rate_rad_s[1]) << effect.effect;
        EXPECT_EQ(out.rate_rad_s[2], plain.rate_rad_s[2]) << effect.effect;
    }
}

TEST(NoiseEffects, ListedTwiceDrawTwice) {
    for (const EffectModel& effect : noise_effects()) {
        SensorModel model = ideal_model();
        model.effects = {effect};
        const Simulated once = simulate(model, rate_hz, 5, 1);
        const bool random = effect.effect == "flicker_missing" || effect.effect == "rrw_missing" ||
                            effect.effect == "angle_noise" || effect.effect == "rtn" ||
                            effect.effect == "common_mode" || effect.effect == "narrowband";
        if (!random) { continue; }
        model.effects = {effect, effect};
        const Simulated twice = simulate(model, rate_hz, 5, 1);
        double same = 0.0;
        for (std::size_t i = 1; i < once.size(); ++i) {
            same +=
                static_cast<double>(std::fabs(twice.rate_rad_s[0][i] - 2.0 * once.rate_rad_s[0][i]) < 1e-12);
        }
        EXPECT_LT(same, 0.7 * block_samples) << effect.effect;
    }
}

TEST(NoiseEffects, GiveTheSameCountsOnEveryMachine) {
    SensorModel model = typical_mpu9250();
    model.effects = noise_effects();
    model.effects.push_back(effect_entry("self_heating", {{"rise_C", 6.0}, {"tau_s", 20.0}}));
    SensorSimulator simulator(model, rate_hz, 7);
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (int block = 0; block < 16; ++block) {
        for (const auto& axis : simulator.next_block().counts) {
            for (const std::int16_t count : axis) {
                hash = (hash ^ static_cast<std::uint16_t>(count)) * 0x100000001B3U;
            }
        }
    }
    EXPECT_EQ(hash, 0x1E359E9001C56FB2U);
}

}  // namespace
}  // namespace gyrolog
