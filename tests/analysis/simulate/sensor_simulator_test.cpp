#include "analysis/simulate/sensor_simulator.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/converter.hpp"

namespace gyrolog {
namespace {

std::uint64_t fnv1a(std::uint64_t hash, const void* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
        hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001B3U;
    }
    return hash;
}

std::uint64_t hash_of_counts(SensorSimulator& simulator, int blocks) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (int i = 0; i < blocks; ++i) {
        for (const auto& axis : simulator.next_block().counts) {
            hash = fnv1a(hash, axis.data(), sizeof axis);
        }
    }
    return hash;
}

double mean(const std::array<double, block_samples>& values) {
    double sum = 0.0;
    for (const double value : values) { sum += value; }
    return sum / static_cast<double>(values.size());
}

SensorModel quiet_model() {
    SensorModel model;
    model.saturation_rad_s = 1e9;
    return model;
}

TEST(SensorSimulator, ASeedGivesTheSameCountsOnEveryMachine) {
    SensorSimulator simulator(typical_mpu9250(), 100.0, 7);
    EXPECT_EQ(hash_of_counts(simulator, 16), 0x2708188ABC12F1F0U);
}

TEST(SensorSimulator, AnotherSeedGivesAnotherSensor) {
    SensorSimulator first(typical_mpu9250(), 100.0, 7);
    SensorSimulator second(typical_mpu9250(), 100.0, 8);
    EXPECT_NE(hash_of_counts(first, 1), hash_of_counts(second, 1));
}

TEST(SensorSimulator, TheMeanIsTheTurnOnBias) {
    SensorModel model = quiet_model();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].bias_rad_s = 0.1 * static_cast<double>(axis + 1);
        model.axes[axis].noise.N_rad_per_sqrt_s = 1e-3;
    }
    SensorSimulator simulator(model, 100.0, 1);
    const SampleBlock& block = simulator.next_block();
    const double sd = 1e-3 * std::sqrt(100.0 / block_samples);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(mean(block.rate_rad_s[axis]), model.axes[axis].bias_rad_s, 4.0 * sd);
    }
}

TEST(SensorSimulator, AxesAreIndependent) {
    SensorModel model = quiet_model();
    for (AxisModel& axis : model.axes) {
        axis.noise.N_rad_per_sqrt_s = 0.1;
        axis.noise.B_rad_per_s = 0.1;
    }
    SensorSimulator simulator(model, 100.0, 1);
    double xy = 0.0;
    double xx = 0.0;
    for (int i = 0; i < 100; ++i) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t k = 1; k < block_samples; ++k) {  // differences: the slow part would need many seeds
            const double x = block.rate_rad_s[0][k] - block.rate_rad_s[0][k - 1];
            const double y = block.rate_rad_s[1][k] - block.rate_rad_s[1][k - 1];
            xy += x * y;
            xx += x * x;
        }
    }
    EXPECT_NEAR(xy / xx, 0.0, 4.0 * std::sqrt(1.5 / (100.0 * block_samples)));
}

TEST(SensorSimulator, TheTemperatureWandersSlowlyAboutTheModelsReference) {
    SensorModel model = quiet_model();
    model.temperature =
        TemperatureModel{.reference_C = 40.0, .bias_rad_s_per_C = {0.01, 0.0, -0.02}, .scale_per_C = {}};
    SensorSimulator simulator(model, 100.0, 3);
    for (int i = 0; i < 50; ++i) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t k = 0; k < block_samples; ++k) {
            const double offset_C = block.temperature_C[k] - 40.0;
            ASSERT_LT(std::fabs(offset_C), 2.5);  // five times its standard deviation
            ASSERT_NEAR(block.rate_rad_s[0][k], 0.01 * offset_C, 1e-12);
            ASSERT_NEAR(block.rate_rad_s[2][k], -0.02 * offset_C, 1e-12);
        }
    }
}

std::vector<double> temperatures_C(double rate_hz, int blocks) {
    SensorSimulator simulator(quiet_model(), rate_hz, 3);
    std::vector<double> all_C;
    for (int i = 0; i < blocks; ++i) {
        const SampleBlock& block = simulator.next_block();
        all_C.insert(all_C.end(), block.die_C.begin(), block.die_C.end());
    }
    return all_C;
}

TEST(SensorSimulator, TheTemperatureIsTheSameCurveAtEverySamplingRate) {
    const std::vector<double> fast_C = temperatures_C(1000.0, 98);  // 100 s
    const std::vector<double> usual_C = temperatures_C(10.0, 5);    // 512 s
    const std::vector<double> slow_C = temperatures_C(0.5, 1);
    const std::vector<double> slowest_C = temperatures_C(0.025, 1);  // knots between samples
    for (std::size_t k = 0; k < 1000; ++k) { ASSERT_NEAR(fast_C[100 * k], usual_C[k], 1e-12) << k; }
    for (std::size_t k = 0; k < 256; ++k) { ASSERT_NEAR(slow_C[k], usual_C[20 * k], 1e-12) << k; }
    for (std::size_t k = 0; k < 51; ++k) { ASSERT_NEAR(slowest_C[k], slow_C[20 * k], 1e-12) << k; }
    EXPECT_GT(std::fabs(usual_C[0] - usual_C[5000]), 1e-3);
}

TEST(SensorSimulator, TheTemperaturesWanderHasItsStandardDeviationAndHalfAnHoursMemory) {
    const std::vector<double> all_C = temperatures_C(1.0 / 1800.0, 10);
    const auto count = static_cast<double>(all_C.size());
    const double reference_C = TemperatureModel{}.reference_C;
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t k = 1; k < all_C.size(); ++k) {
        squares += std::pow(all_C[k] - reference_C, 2.0);
        products += (all_C[k] - reference_C) * (all_C[k - 1] - reference_C);
    }
    // With a correlation r from one to the next: Bartlett's variances, (1 + r^2) / (1 - r^2) and 1 - r^2.
    const double r = std::exp(-1.0);
    EXPECT_NEAR(squares / count / 0.25, 1.0, 4.0 * std::sqrt(2.0 * (1.0 + r * r) / (1.0 - r * r) / count));
    EXPECT_NEAR(products / squares, r, 4.0 * std::sqrt((1.0 - r * r) / count));
}

TEST(SensorSimulator, RatesAreWholeCountsClippedAtTheSaturation) {
    SensorModel model = quiet_model();
    model.lsb_rad_s = 0.01;
    model.saturation_rad_s = 1.0;
    model.axes[0].noise.N_rad_per_sqrt_s = 1.0;
    SensorSimulator simulator(model, 1.0, 1);
    const SampleBlock& block = simulator.next_block();
    int highest = 0;
    int lowest = 0;
    for (std::size_t i = 0; i < block_samples; ++i) {
        const int count = block.counts[0][i];
        ASSERT_EQ(block.rate_rad_s[0][i], count * 0.01);
        highest = std::max(highest, count);
        lowest = std::min(lowest, count);
    }
    EXPECT_EQ(highest, 100);
    EXPECT_EQ(lowest, -101);
}

TEST(Converter, RoundsHalfAwayFromZeroAndStaysWithinSixteenBits) {
    const Converter converter(1.0, 1e9);
    EXPECT_EQ(converter(0.49), 0);
    EXPECT_EQ(converter(0.5), 1);
    EXPECT_EQ(converter(-0.5), -1);
    EXPECT_EQ(converter(1.5), 2);
    EXPECT_EQ(converter(-2.5), -3);
    EXPECT_EQ(converter(1e8), 32767);
    EXPECT_EQ(converter(-1e8), -32768);
}

EffectModel effect_of(std::string name, std::map<std::string, double> params) {
    return {.effect = std::move(name), .axes = {"x"}, .params = std::move(params), .carried_json = {}};
}

std::optional<std::string> accelerometer_refusal(const std::string& name,
                                                 const std::map<std::string, double>& params) {
    SensorModel model = quiet_model();
    model.accelerometer.emplace().effects = {effect_of(name, params)};
    return simulation_refusal(model);
}

TEST(Effects, AnAccelerometersParametersAreInItsOwnUnitAndSoNamed) {
    EXPECT_EQ(accelerometer_refusal("bias_step", {{"at_s", 1.0}, {"step_g", 0.1}}), std::nullopt);
    EXPECT_EQ(accelerometer_refusal("bias_step", {{"at_s", 1.0}, {"step_dps", 1.0}}),
              "accelerometer: effect 'bias_step' has no parameter 'step_dps', which is of a gyro; it has "
              "step_g");
    EXPECT_EQ(accelerometer_refusal("bias_step", {{"at_s", 1.0}}),
              "accelerometer: effect 'bias_step' lacks its parameter 'step_g'");
    EXPECT_EQ(accelerometer_refusal("saturation", {{"limit_mg", 1.0}}),
              "accelerometer: effect 'saturation' has no parameter 'limit_mg'; it has limit_g");
    EXPECT_EQ(accelerometer_refusal("saturation", {{"limit_g", -1.0}}),
              "accelerometer: effect 'saturation': limit_g is not above zero");
}

TEST(Effects, AnUnknownEffectOrAMissingParameterIsRefusedByName) {
    SensorModel model = quiet_model();
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    model.effects = {effect_of("phase_of_the_moon", {})};
    EXPECT_EQ(simulation_refusal(model), "effect 'phase_of_the_moon' cannot be simulated by this version");
    model.effects = {effect_of("bias_step", {{"at_s", 1.0}})};
    EXPECT_EQ(simulation_refusal(model), "effect 'bias_step' lacks its parameter 'step_dps'");
    model.effects = {effect_of("bias_step", {{"at_s", 1.0}, {"step_g", 1.0}})};
    EXPECT_EQ(simulation_refusal(model),
              "effect 'bias_step' has no parameter 'step_g'; it has step_dps, at_s");
    model.effects = {effect_of("bias_step", {{"at_s", 1.0}, {"step_dps", 1.0}})};
    model.effects[0].axes = {"w"};
    EXPECT_EQ(simulation_refusal(model), "effect 'bias_step' names an axis 'w' that is not x, y or z");
}

TEST(Effects, ABiasStepComesAtItsTimeOnItsAxisOnly) {
    SensorModel model = quiet_model();
    model.effects = {effect_of("bias_step", {{"at_s", 2.0}, {"step_dps", 10.0}})};
    SensorSimulator simulator(model, 100.0, 1);
    const SampleBlock& block = simulator.next_block();
    EXPECT_EQ(block.rate_rad_s[0][199], 0.0);
    EXPECT_EQ(block.rate_rad_s[0][200], 10.0 * rad_per_deg);
    EXPECT_EQ(block.rate_rad_s[1][200], 0.0);
}

TEST(Effects, ARampGrowsByItsSlopeEverySecond) {
    SensorModel model = quiet_model();
    model.effects = {effect_of("rate_ramp", {{"ramp_dps_per_s", 3.0}})};
    SensorSimulator simulator(model, 100.0, 1);
    simulator.next_block();
    EXPECT_NEAR(simulator.next_block().rate_rad_s[0][0], 3.0 * rad_per_deg * 10.24, 1e-12);
}

TEST(Effects, GaussMarkovNoiseHasItsVarianceFromTheStartAndItsCorrelationTime) {
    SensorModel model = quiet_model();
    model.effects = {effect_of("gauss_markov", {{"sigma_dps", 1.0}, {"tau_s", 0.1}})};
    double first = 0.0;
    double variance = 0.0;
    double at_tau = 0.0;
    constexpr unsigned seeds = 1000;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        SensorSimulator simulator(model, 100.0, seed);
        const auto& x = simulator.next_block().rate_rad_s[0];
        first += x[0] * x[0] / seeds;
        for (std::size_t i = 0; i + 10 < block_samples; ++i) {
            variance += x[i] * x[i] / (seeds * (block_samples - 10.0));
            at_tau += x[i] * x[i + 10] / (seeds * (block_samples - 10.0));
        }
    }
    const double sigma2 = rad_per_deg * rad_per_deg;
    EXPECT_NEAR(first / sigma2, 1.0, 4.0 * std::sqrt(2.0 / seeds));
    // One independent value in about 2 tau: 50 a block.
    EXPECT_NEAR(variance / sigma2, 1.0, 4.0 * std::sqrt(2.0 / (50.0 * seeds)));
    EXPECT_NEAR(at_tau / variance, std::exp(-1.0), 4.0 * std::sqrt(1.0 / (50.0 * seeds)));
}

TEST(Effects, SeveralGaussMarkovNoisesOfOneAxisAreIndependent) {
    SensorModel model = quiet_model();
    const EffectModel one = effect_of("gauss_markov", {{"sigma_dps", 1.0}, {"tau_s", 0.02}});
    model.effects = {one, one};
    double variance = 0.0;
    constexpr unsigned seeds = 200;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        SensorSimulator simulator(model, 100.0, seed);
        for (const double x : simulator.next_block().rate_rad_s[0]) { variance += x * x; }
    }
    variance /= seeds * static_cast<double>(block_samples) * rad_per_deg * rad_per_deg;
    // The same noise twice would have a variance of 4.
    EXPECT_NEAR(variance, 2.0, 0.1);
}

TEST(Effects, AToneIsASinusoidAndFoldsAboveHalfTheRate) {
    SensorModel model = quiet_model();
    model.effects = {effect_of("tone", {{"f_hz", 60.0}, {"amplitude_dps", 2.0}, {"phase_rad", 0.3}})};
    SensorSimulator simulator(model, 100.0, 1);
    simulator.next_block();
    const SampleBlock& block = simulator.next_block();
    for (std::size_t i = 0; i < block_samples; i += 37) {
        const double t_s = static_cast<double>(block_samples + i) / 100.0;
        EXPECT_NEAR(block.rate_rad_s[0][i], 2.0 * rad_per_deg * std::sin(2.0 * pi * 60.0 * t_s + 0.3), 1e-12);
        EXPECT_NEAR(block.rate_rad_s[0][i], 2.0 * rad_per_deg * std::sin(-2.0 * pi * 40.0 * t_s + 0.3),
                    1e-12);
        EXPECT_EQ(block.rate_rad_s[1][i], 0.0);
    }
}

}  // namespace
}  // namespace gyrolog
