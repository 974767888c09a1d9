#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/noise/sensor_noise.hpp"
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

}  // namespace
}  // namespace gyrolog
