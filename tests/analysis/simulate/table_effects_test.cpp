// Effects that follow a table, and the autoregression behind that of the density.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/autoregression.hpp"
#include "analysis/simulate/chain.hpp"
#include "tests/analysis/simulate/periodogram.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

EffectModel table_entry(std::string name, std::map<std::string, std::vector<double>> table,
                        std::vector<std::string> axes = {}) {
    return {std::move(name), std::move(axes), {}, "", std::move(table)};
}

SensorModel with_table(SensorModel model, EffectModel entry) {
    model.effects.push_back(std::move(entry));
    return model;
}

// y_k = 0.5 y_(k-1) - 0.3 y_(k-2) + w_k: r_1/r_0 = a_1 / (1 - a_2) (Box, Jenkins, Time Series
// Analysis, 3.2.27).
std::vector<double> second_order_covariances(std::size_t count) {
    constexpr double a1 = 0.5;
    constexpr double a2 = -0.3;
    const double r0 = (1.0 - a2) / ((1.0 + a2) * ((1.0 - a2) * (1.0 - a2) - a1 * a1));
    std::vector<double> r = {r0, r0 * a1 / (1.0 - a2)};
    while (r.size() < count) { r.push_back(a1 * r[r.size() - 1] + a2 * r[r.size() - 2]); }
    return r;
}

TEST(Autoregression, HasTheCoefficientsThatMadeTheCovariances) {
    const Autoregression process(second_order_covariances(6));
    ASSERT_EQ(process.order(), 5U);
    const std::span<const double> a = process.predictor(5);
    EXPECT_NEAR(a[0], 0.5, 1e-14);
    EXPECT_NEAR(a[1], -0.3, 1e-14);
    for (std::size_t j = 2; j < 5; ++j) { EXPECT_NEAR(a[j], 0.0, 1e-14); }
    EXPECT_NEAR(process.error_sd(5), 1.0, 1e-14);
    EXPECT_NEAR(process.error_sd(0) * process.error_sd(0), process.variance(), 1e-14);
    for (const double turns : {0.0, 0.1, 0.25, 0.5}) {
        const auto z = std::polar(1.0, -2.0 * pi * turns);
        EXPECT_NEAR(process.density(turns), 1.0 / std::norm(1.0 - 0.5 * z + 0.3 * z * z), 1e-12);
    }
}

// The covariance of any two samples, the first ones too, as the sum over the white noise of what the filter
// makes of it.
TEST(Autoregression, IsStationaryFromTheFirstSampleOn) {
    const std::vector<double> r = second_order_covariances(6);
    const auto process = std::make_shared<const Autoregression>(r);
    constexpr std::size_t samples = 12;
    std::vector<std::vector<double>> answers;
    for (std::size_t impulse = 0; impulse < samples; ++impulse) {
        std::vector<double> white(samples, 0.0);
        white[impulse] = 1.0;
        AutoregressiveFilter filter(process);
        filter.apply(std::span(white).first(5));
        filter.apply(std::span(white).subspan(5));
        answers.push_back(std::move(white));
    }
    for (std::size_t i = 0; i < samples; ++i) {
        for (std::size_t j = 0; j <= std::min<std::size_t>(i, 5); ++j) {
            double covariance = 0.0;
            for (const auto& answer : answers) { covariance += answer[i] * answer[i - j]; }
            EXPECT_NEAR(covariance, r[j], 1e-12) << i << ' ' << j;
        }
    }
}

TEST(DensityTable, OfOneChangesNothing) {
    const SensorModel plain = white_model(0.02);
    const SensorModel shaped =
        with_table(plain, table_entry("density_table", {{"f_hz", {0.0, 20.0}}, {"factor", {1.0, 1.0}}}));
    const Simulated before = simulate(plain, rate_hz, 3, 2);
    const Simulated after = simulate(shaped, rate_hz, 3, 2);
    for (std::size_t i = 0; i < before.size(); ++i) {
        ASSERT_NEAR(after.rate_rad_s[0][i], before.rate_rad_s[0][i], 1e-12) << i;
    }
}

// At a rate of its own the factor is that of the same frequencies. A periodogram's octave is known to a few
// hundredths (seed 5).
TEST(DensityTable, IsTheFactorOfTheDensityAtEveryFrequency) {
    const EffectModel entry = table_entry(
        "density_table", {{"f_hz", {0.0, 10.0, 20.0, 30.0}}, {"factor", {1.0, 1.0, 4.0, 0.5}}}, {"x"});
    const SensorModel model = with_table(white_model(0.02), entry);
    for (const double at_hz : {100.0, 160.0}) {
        SpectrumAverage x(4096);
        SpectrumAverage y(4096);
        const Simulated out = simulate(model, at_hz, 5, 400);
        for (std::size_t from = 0; from + 4096 <= out.size(); from += 4096) {
            x.add(std::span(out.rate_rad_s[0]).subspan(from, 4096));
            y.add(std::span(out.rate_rad_s[1]).subspan(from, 4096));
        }
        const Course factor = Course(entry.table.at("f_hz"), entry.table.at("factor"));
        const double white = 0.02 * 0.02 * at_hz;
        int octaves = 0;
        for (const OctaveRatio& octave :
             octave_ratios(x, [&](double turns) { return white * factor(turns * at_hz); })) {
            // The filter rounds the table's corners.
            EXPECT_NEAR(octave.ratio, 1.0, 4.0 * octave.sd + 0.01) << octave.from_nu * at_hz << " Hz";
            ++octaves;
        }
        EXPECT_EQ(octaves, 10);
        for (const OctaveRatio& octave : octave_ratios(y, [&](double) { return white; })) {
            EXPECT_NEAR(octave.ratio, 1.0, 4.0 * octave.sd);
        }
    }
}

// Nearly all is predicted from the samples before, up to rounding.
TEST(DensityTable, MayBeNextToNothingInHalfOfTheBand) {
    const SensorModel model =
        with_table(white_model(0.02), table_entry("density_table", {{"f_hz", {0.0, 24.0, 26.0, 50.0}},
                                                                    {"factor", {1.0, 1.0, 1e-300, 1e-300}}}));
    const Simulated out = simulate(model, rate_hz, 3, 40);
    double sum = 0.0;
    for (const double rate_rad_s : out.rate_rad_s[0]) { sum += rate_rad_s * rate_rad_s; }
    // Half of the white noise's variance, known to a hundredth.
    EXPECT_NEAR(sum / static_cast<double>(out.size()), 0.5 * 0.02 * 0.02 * rate_hz,
                0.05 * 0.02 * 0.02 * rate_hz);
}

TEST(LevelTable, IsTheWhiteNoiseTimesItsCourse) {
    const SensorModel model =
        with_table(white_model(0.02),
                   table_entry("level_table", {{"t_s", {100.0, 200.0}}, {"factor", {1.0, 3.0}}}, {"y"}));
    const Simulated out = simulate(model, rate_hz, 3, 300);
    const auto mean_square = [&](std::size_t axis, double from_s, double to_s) {
        const auto from = static_cast<std::size_t>(from_s * rate_hz);
        const auto to = static_cast<std::size_t>(to_s * rate_hz);
        double sum = 0.0;
        for (std::size_t i = from; i < to; ++i) { sum += out.rate_rad_s[axis][i] * out.rate_rad_s[axis][i]; }
        return sum / static_cast<double>(to - from) / (0.02 * 0.02 * rate_hz);
    };
    // Of 10 000 samples, four standard deviations.
    const double chance = 4.0 * std::sqrt(2.0 / 1e4);
    EXPECT_NEAR(mean_square(1, 0.0, 100.0), 1.0, chance);
    EXPECT_NEAR(mean_square(1, 200.0, 300.0) / 9.0, 1.0, chance);
    // The mean of (1 + 2 u)^2 over 0 to 1.
    EXPECT_NEAR(mean_square(1, 100.0, 200.0) / (13.0 / 3.0), 1.0, 2.0 * chance);
    EXPECT_NEAR(mean_square(0, 200.0, 300.0), 1.0, chance);
}

TEST(TimeTable, IsStraightBetweenItsPointsAndLevelBeyondThem) {
    const SensorModel model = with_table(
        ideal_model(),
        table_entry("time_table", {{"t_s", {1.0, 2.0, 4.0}}, {"bias_dps", {0.0, 1.0, -1.0}}}, {"y"}));
    const Simulated out = simulate(model, rate_hz, 3, 1);
    for (const auto& [at_s, bias_dps] : std::vector<std::pair<double, double>>{
             {0.0, 0.0}, {1.0, 0.0}, {1.5, 0.5}, {2.0, 1.0}, {3.0, 0.0}, {4.0, -1.0}, {6.0, -1.0}}) {
        const auto i = static_cast<std::size_t>(at_s * rate_hz);
        EXPECT_NEAR(out.rate_rad_s[1][i], bias_dps * rad_per_deg, 1e-12) << at_s;
        EXPECT_EQ(out.rate_rad_s[0][i], 0.0);
    }
}

TEST(TemperatureTable, IsStraightBetweenItsPointsAndLevelBeyondThem) {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 20.0 + t_s; };
    const SensorModel model = with_table(
        ideal_model(), table_entry("temperature_table",
                                   {{"temp_C", {25.0, 30.0, 40.0}}, {"bias_dps", {1.0, 3.0, 2.0}}}, {"y"}));
    const Simulated out = simulate(model, rate_hz, 3, 3, world);
    for (const auto& [at_s, bias_dps] : std::vector<std::pair<double, double>>{
             {1.0, 1.0}, {5.0, 1.0}, {7.5, 2.0}, {10.0, 3.0}, {15.0, 2.5}, {25.0, 2.0}}) {
        const auto i = static_cast<std::size_t>(at_s * rate_hz);
        EXPECT_NEAR(out.rate_rad_s[1][i], bias_dps * rad_per_deg, 1e-12) << at_s;
        EXPECT_NEAR(out.rate_rad_s[0][i], 0.0, 1e-12);
    }
}

TEST(RateTable, AddsItsValueAtTheRate) {
    const SensorModel model = with_table(
        ideal_model(),
        table_entry("rate_table", {{"rate_dps", {-50.0, 0.0, 50.0}}, {"added_dps", {0.5, 0.0, 1.0}}}, {"x"}));
    const auto world = world_turning([](double t_s) {
        return Vector3{(t_s - 5.0) * 10.0 * rad_per_deg, 0.1, 0.0};
    });
    const Simulated out = simulate(model, rate_hz, 3, 1, world);
    for (const auto& [at_s, rate_dps, added_dps] : std::vector<std::array<double, 3>>{
             {0.0, -50.0, 0.5}, {2.5, -25.0, 0.25}, {5.0, 0.0, 0.0}, {7.5, 25.0, 0.5}, {10.0, 50.0, 1.0}}) {
        const auto i = static_cast<std::size_t>(at_s * rate_hz);
        EXPECT_NEAR(out.rate_rad_s[0][i], (rate_dps + added_dps) * rad_per_deg, 1e-12) << at_s;
        EXPECT_NEAR(out.rate_rad_s[1][i], 0.1, 1e-12);
    }
}

TEST(TableEffects, SayWhatIsWrongWithATable) {
    const auto refusal = [](std::map<std::string, std::vector<double>> table) {
        return effect_refusal(table_entry("density_table", std::move(table))).value_or("accepted");
    };
    EXPECT_EQ(refusal({{"f_hz", {1.0, 2.0}}, {"factor", {1.0, 2.0}}}), "accepted");
    EXPECT_EQ(refusal({{"f_hz", {1.0}}}), "effect 'density_table' lacks the column 'factor' of its table");
    EXPECT_EQ(refusal({{"f_hz", {}}, {"factor", {}}}),
              "effect 'density_table' lacks the column 'f_hz' of its table");
    EXPECT_EQ(refusal({{"f_hz", {1.0, 2.0}}, {"factor", {1.0}}}),
              "effect 'density_table' has columns of 2 and 1 numbers in its table");
    EXPECT_EQ(refusal({{"f_hz", {2.0, 2.0}}, {"factor", {1.0, 1.0}}}),
              "effect 'density_table' has a table whose 'f_hz' does not increase");
    EXPECT_EQ(refusal({{"f_hz", {1.0, 2.0}}, {"factor", {1.0, 0.0}}}),
              "effect 'density_table' has a 'factor' in its table that is not above zero");
    EXPECT_EQ(refusal({{"f_hz", {1.0}}, {"factor", {1.0}}, {"gain", {1.0}}}),
              "effect 'density_table' has no column 'gain' in its table");
    EffectModel tone = effect_entry("tone", {{"f_hz", 3.0}, {"amplitude_dps", 1.0}});
    tone.table["f_hz"] = {1.0};
    EXPECT_EQ(effect_refusal(tone).value_or("accepted"), "effect 'tone' has no column 'f_hz' in its table");
}

}  // namespace
}  // namespace gyrolog
