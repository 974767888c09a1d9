#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/noise/sensor_noise.hpp"
#include "tests/analysis/noise/temperature_courses.hpp"
#include "tests/analysis/noise/test_recording.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

TEST(Analyze, ReportsEveryGyroAxisAndOnlyThose) {
    Recording recording =
        test::recording_of({std::vector<double>(100, 0.5), std::vector<double>(100, 0.25)}, 10.0);
    recording.columns.push_back({"ax", "m/s^2", std::vector<double>(100, 9.8), 1.0, 0.0, "m_s2"});
    recording.warnings = {"odd"};
    const AnalysisReport report = analyze(recording);
    ASSERT_THAT(report.axes, SizeIs(2));
    EXPECT_EQ(report.axes[0].axis, "x");
    EXPECT_EQ(report.axes[1].axis, "y");
    EXPECT_EQ(report.axes[1].bias.value, 0.25);
    EXPECT_EQ(report.axes[1].bias.expanded_uncertainty, 0.0);
    EXPECT_THAT(report.warnings, Contains("odd"));
    EXPECT_EQ(report.unit.name, "rad/s");
}

// Three axes of noise as a gyro's and, the same numbers, as an accelerometer's.
Recording twice_the_same(std::size_t samples) {
    std::vector<std::vector<double>> axes;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        axes.push_back(test::sensor_noise({0.0, 0.01, 0.002, 1e-4, 0.0}, samples, 10.0, seed));
    }
    // A line and an offset, so that these are compared, too.
    for (std::size_t i = 0; i < samples; ++i) {
        axes[1][i] += 9.8;
        axes[2][i] += 0.02 * std::sin(2.0 * pi * 2.5 * static_cast<double>(i) / 10.0);
    }
    Recording recording = test::recording_of(axes, 10.0);
    for (std::size_t i = 0; i < 3; ++i) {
        Column column = recording.columns[i];
        column.name[0] = 'a';
        column.unit = "m/s^2";
        column.source_unit = "m_s2";
        recording.columns.push_back(std::move(column));
    }
    return recording;
}

void expect_same(const AxisReport& a, const AxisReport& b) {
    EXPECT_EQ(a.axis, b.axis);
    for (const NoiseTerm term : all_noise_terms) {
        EXPECT_EQ(a.fit[term].state, b.fit[term].state) << name_of(term);
        EXPECT_EQ(a.fit[term].value, b.fit[term].value) << name_of(term);
        EXPECT_EQ(a.fit[term].lo, b.fit[term].lo) << name_of(term);
        EXPECT_EQ(a.fit[term].hi, b.fit[term].hi) << name_of(term);
        EXPECT_EQ(a.fit[term].upper, b.fit[term].upper) << name_of(term);
    }
    EXPECT_EQ(a.bias.value, b.bias.value);
    EXPECT_EQ(a.bias.expanded_uncertainty, b.bias.expanded_uncertainty);
    ASSERT_EQ(a.curve.points.size(), b.curve.points.size());
    for (std::size_t i = 0; i < a.curve.points.size(); ++i) {
        EXPECT_EQ(a.curve.points[i].deviation, b.curve.points[i].deviation);
        EXPECT_EQ(a.curve.points[i].lo, b.curve.points[i].lo);
    }
    EXPECT_EQ(a.spectrum.points.back().density, b.spectrum.points.back().density);
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) { EXPECT_EQ(a.lines[i].f_hz, b.lines[i].f_hz); }
}

TEST(Analyze, OfTheSameNumbersSaysTheSameWhetherAGyrosOrAnAccelerometers) {
    const AnalysisReport report = analyze(twice_the_same(5000));
    ASSERT_THAT(report.axes, SizeIs(3));
    ASSERT_TRUE(report.accelerometer);
    ASSERT_THAT(report.accelerometer->axes, SizeIs(3));
    for (std::size_t i = 0; i < 3; ++i) { expect_same(report.axes[i], report.accelerometer->axes[i]); }
    EXPECT_FALSE(report.axes[2].lines.empty());
    EXPECT_EQ(report.accelerometer->unit.name, "m/s^2");
    ASSERT_THAT(report.accelerometer->gravity, SizeIs(1));
    EXPECT_STREQ(report.accelerometer->gravity[0].gravity.up_name(), "+y");
    EXPECT_NEAR(report.accelerometer->gravity[0].gravity.size.value, 9.8, 0.02);
}

TEST(Analyze, LooksAtTheSensorsThatAreWanted) {
    const Recording recording = twice_the_same(500);
    AnalysisOptions options;
    options.sensors = Sensors::gyro;
    const AnalysisReport gyro = analyze(recording, options);
    EXPECT_THAT(gyro.axes, SizeIs(3));
    EXPECT_FALSE(gyro.accelerometer);
    options.sensors = Sensors::accelerometer;
    const AnalysisReport accelerometer = analyze(recording, options);
    EXPECT_THAT(accelerometer.axes, testing::IsEmpty());
    ASSERT_TRUE(accelerometer.accelerometer);
    EXPECT_THAT(accelerometer.accelerometer->axes, SizeIs(3));
    Recording without = recording;
    without.columns.resize(3);
    const AnalysisReport none = analyze(without, options);
    EXPECT_FALSE(none.has_axes());
    EXPECT_THAT(none.warnings, Contains(HasSubstr("no accelerometer column")));
}

TEST(Analyze, AnAccelerometersWarningsNameIt) {
    Recording recording = twice_the_same(500);
    recording.columns[3].data = std::vector<double>(500, 0.0);
    EXPECT_THAT(analyze(recording).warnings,
                Contains(HasSubstr("accelerometer axis x: all samples are equal")));
    recording.columns[4].data = std::vector<double>(500, 5.0);
    EXPECT_THAT(analyze(recording).warnings,
                Contains(HasSubstr("accelerometer (0.51 g): the mean over the record is not gravity")));
}

TEST(Analyze, RowsWithoutTheAccelerometerAreMissingToItAlone) {
    Recording recording = twice_the_same(3000);
    auto& ay = std::get<std::vector<double>>(recording.columns[4].data);
    for (std::size_t i = 1000; i < 1100; ++i) { ay[i] = std::nan(""); }
    const AnalysisReport report = analyze(recording);
    ASSERT_TRUE(report.accelerometer);
    EXPECT_THAT(report.warnings, Contains(HasSubstr("accelerometer: 100 of the rows")));
    EXPECT_EQ(report.axes[0].curve.points.front().terms, 2999);
    EXPECT_EQ(report.accelerometer->axes[0].curve.points.front().terms, 2898);
    EXPECT_NEAR(report.accelerometer->axes[1].bias.value, 9.8, 0.02);
}

TEST(Analyze, SaysWhichAveragingFactorsTheRecordCannotAnswer) {
    AnalysisOptions options;
    options.m = {1, 51};
    const AnalysisReport report = analyze(test::recording_of({std::vector<double>(100, 0.5)}, 10.0), options);
    EXPECT_THAT(report.axes.at(0).curve.points, SizeIs(1));
    EXPECT_THAT(report.warnings, Contains(HasSubstr("m = 51 left out")));
}

TEST(Analyze, GivesTheSameNumbersForAnyNumberOfThreads) {
    std::vector<std::vector<double>> axes;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        axes.push_back(test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 5000, 10.0, seed));
    }
    const Recording recording = test::recording_of(axes, 10.0);
    AnalysisOptions options;
    const AnalysisReport one = analyze(recording, options);
    options.threads = 3;
    const AnalysisReport three = analyze(recording, options);
    ASSERT_THAT(three.axes, SizeIs(3));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(one.axes[i].axis, three.axes[i].axis);
        EXPECT_EQ(one.axes[i].curve.points.back().deviation, three.axes[i].curve.points.back().deviation);
        EXPECT_EQ(one.axes[i].fit[NoiseTerm::N].value, three.axes[i].fit[NoiseTerm::N].value);
        EXPECT_EQ(one.axes[i].spectrum.points.back().density, three.axes[i].spectrum.points.back().density);
        EXPECT_EQ(one.axes[i].bias.expanded_uncertainty, three.axes[i].bias.expanded_uncertainty);
    }
}

TEST(Analyze, WarnsOfAClockThatIsOffItsNominalRate) {
    Recording recording =
        test::recording_of({test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 500, 99.3, 1)}, 99.3);
    recording.nominal_rate_hz = 100.0;
    recording.rate_sd_hz = 0.01;
    EXPECT_THAT(analyze(recording).warnings, Contains(HasSubstr("-0.7 % off the nominal 100 Hz")));
    recording.rate_hz = 99.95;
    EXPECT_THAT(analyze(recording).warnings, testing::IsEmpty());
}

TEST(Analyze, NamesAxesThatAreClippedHeavyTailedOrStuck) {
    const auto noise = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 2000, 100.0, 1);
    auto clipped = noise;
    for (double& x : clipped) { x = std::min(x, 0.1); }
    auto spiky = noise;
    for (std::size_t i = 0; i < spiky.size(); i += 200) { spiky[i] += 1.0; }
    const AnalysisReport report = analyze(test::recording_of({clipped, spiky, noise}, 100.0));
    EXPECT_THAT(report.warnings, Contains(HasSubstr("axis x: the samples are clipped")));
    EXPECT_THAT(report.warnings, Contains(testing::ContainsRegex("axis y \\(excess kurtosis .*heavy tails")));
    const AnalysisReport still =
        analyze(test::recording_of({noise, std::vector<double>(2000, 0.5), noise}, 100.0));
    EXPECT_THAT(still.warnings, ElementsAre(HasSubstr("axis y: all samples are equal")));
}

TEST(Analyze, OfOutliersHasOneLineForAllAxes) {
    std::vector<std::vector<double>> axes;
    for (const std::size_t spikes : {3U, 5U}) {
        axes.push_back(test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 2000, 100.0, spikes));
        for (std::size_t i = 0; i < spikes; ++i) { axes.back()[100 + 300 * i] += 5.0; }
    }
    AnalysisOptions robust;
    robust.robust = true;
    EXPECT_THAT(analyze(test::recording_of(axes, 100.0), robust).warnings,
                ElementsAre(HasSubstr("axes x (3), y (5): outliers")));
}

TEST(Analyze, OfNothingSaysSo) {
    EXPECT_THAT(analyze(Recording{}).warnings, Contains(HasSubstr("nothing to analyse")));
}

// Noise of a gyro at rest for 43 min, with so much drift on x, none on y, and the temperature of a warm-up.
Recording warming_up(double slope_per_C) {
    constexpr std::size_t samples = 25'600;
    const std::vector<double> temperature_C = test::temperature_course(test::Course::warm_up, samples, 1);
    std::vector<std::vector<double>> axes;
    for (const std::uint64_t seed : {11U, 12U}) {
        axes.push_back(test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, samples, 10.0, seed));
    }
    for (std::size_t i = 0; i < samples; ++i) { axes[0][i] += slope_per_C * temperature_C[i]; }
    return test::with_temperature(axes, 10.0, temperature_C);
}

TEST(Analyze, TakesOffTheDriftThatFollowsTheTemperatureAndSaysSo) {
    const Recording quiet = warming_up(0.0);
    const Recording drifting = warming_up(0.02);
    const AnalysisReport report = analyze(drifting);
    const AxisReport& x = report.axes.at(0);
    ASSERT_TRUE(x.temperature);
    EXPECT_TRUE(x.temperature->is_taken_off);
    EXPECT_NEAR(x.temperature->slope_per_C, 0.02, 4.0 * x.temperature->sd_per_C);
    EXPECT_THAT(report.warnings, Contains(HasSubstr("the bias follows the temperature")));
    EXPECT_THAT(report.warnings, Contains(HasSubstr("--keep-temperature")));
    // What is left is as without the drift: the curve within what the slope is uncertain by, K not there.
    const AxisReport truth = analyze(quiet).axes.at(0);
    EXPECT_EQ(x.fit[NoiseTerm::K].state, truth.fit[NoiseTerm::K].state);
    EXPECT_NEAR(x.fit[NoiseTerm::N].value, truth.fit[NoiseTerm::N].value, truth.fit[NoiseTerm::N].sd);
    ASSERT_EQ(x.curve.points.size(), truth.curve.points.size());
    for (std::size_t i = 0; i < x.curve.points.size() && x.curve.points[i].tau_s < 100.0; ++i) {
        EXPECT_NEAR(x.curve.points[i].deviation / truth.curve.points[i].deviation, 1.0, 0.05);
    }
    // The bias is that at the mean temperature: the mean of what was read.
    const std::vector<double> read = drifting.columns[0].values();
    double mean = 0.0;
    for (const double value : read) { mean += value / static_cast<double>(read.size()); }
    EXPECT_NEAR(x.bias.value, mean, 1e-9);
}

TEST(Analyze, KeepsTheDriftWhereItIsToldTo) {
    AnalysisOptions keep;
    keep.keep_temperature = true;
    Recording recording = warming_up(0.02);
    const AnalysisReport kept = analyze(recording, keep);
    const AxisReport& x = kept.axes.at(0);
    ASSERT_TRUE(x.temperature);
    EXPECT_TRUE(x.temperature->is_there);
    EXPECT_FALSE(x.temperature->is_taken_off);
    EXPECT_THAT(kept.warnings, Contains(HasSubstr("was left in")));
    recording.columns.pop_back();  // the temperature
    const AnalysisReport none = analyze(recording);
    EXPECT_FALSE(none.axes.at(0).temperature);
    EXPECT_THAT(none.warnings, testing::Not(Contains(HasSubstr("temperature, "))));
    expect_same(x, none.axes.at(0));
    // Left in, most of the curve's upper end is the drift.
    const AxisReport taken_off = analyze(warming_up(0.02)).axes.at(0);
    const auto at_200_s = [](const AxisReport& axis) {
        const auto& points = axis.curve.points;
        return std::ranges::find_if(points, [](const AllanPoint& p) { return p.tau_s > 200.0; })->deviation;
    };
    EXPECT_GT(at_200_s(x), 3.0 * at_200_s(taken_off));
}

TEST(Analyze, ChangesNotABitWhereTheBiasDoesNotFollowTheTemperature) {
    Recording recording = warming_up(0.02);
    const AnalysisReport with = analyze(recording);
    recording.columns.pop_back();
    const AnalysisReport without = analyze(recording);
    ASSERT_TRUE(with.axes.at(1).temperature);
    EXPECT_FALSE(with.axes[1].temperature->is_there);
    EXPECT_GT(with.axes[1].temperature->sd_per_C, 0.0);
    expect_same(with.axes[1], without.axes.at(1));
}

}  // namespace
}  // namespace gyrolog
