#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/noise/over_seeds.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

Recording recording_of(std::vector<std::vector<double>> axes, double rate_hz) {
    Recording recording;
    recording.name = "test";
    recording.rate_hz = rate_hz;
    recording.segments = {{0, axes.front().size(), 0}};
    const char* names[] = {"gx", "gy", "gz"};
    for (std::size_t i = 0; i < axes.size(); ++i) {
        recording.columns.push_back({names[i], "rad/s", std::move(axes[i]), 1.0, 0.0, "rad_s"});
    }
    return recording;
}

// The published measurement: 100 samples at 100 Hz with a standard deviation of 0.1395 dps give (-0.3421 +-
// 0.0279) dps at coverage factor 2. Here the mean over many such records; one alone knows its standard
// deviation to 7 %.
TEST(StaticBias, OfAHundredWhiteSamplesHasThePublishedUncertainty) {
    double mean_uncertainty = 0.0;
    constexpr int records = 60;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        auto samples = test::sensor_noise({0.0, 0.1395 / 10.0, 0.0, 0.0, 0.0}, 100, 100.0, seed);
        for (double& x : samples) { x -= 0.3421; }
        const AnalysisReport report = analyze(recording_of({samples}, 100.0));
        mean_uncertainty += report.axes.at(0).bias.expanded_uncertainty / records;
    }
    EXPECT_NEAR(mean_uncertainty, 0.0279, 0.1 * 0.0279);
}

TEST(StaticBias, CoversTheBiasOfTheNextRecordAtCoverageTwo) {
    int covered = 0;
    constexpr int records = 60;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 40000, 10.0, seed);
        const std::vector<double> first(samples.begin(), samples.begin() + 20000);
        double next = 0.0;
        for (std::size_t i = 20000; i < samples.size(); ++i) { next += samples[i] / 20000.0; }
        const StaticBias bias = analyze(recording_of({first}, 10.0)).axes.at(0).bias;
        // Both records have that uncertainty, so their difference has root two of it.
        covered += std::abs(bias.value - next) < std::sqrt(2.0) * bias.expanded_uncertainty ? 1 : 0;
    }
    // 95 % of 60 is 57 with a standard deviation of 1.7; the uncertainty is itself an estimate.
    EXPECT_GE(covered, 51);
}

// Two hours with N, B and K, of which K is at the edge of what such a record shows.
TEST(StaticBias, CoversTheNextRecordsBiasWithARandomWalkAsWell) {
    constexpr std::size_t records = 100;
    constexpr std::size_t samples = 72'000;
    const auto covered = test::over_seeds(records, [](std::uint64_t seed) {
        const auto both = test::sensor_noise({0.0, 0.01, 0.002, 1e-4, 0.0}, 2 * samples, 10.0, seed);
        double next = 0.0;
        for (std::size_t i = samples; i < both.size(); ++i) { next += both[i] / samples; }
        const StaticBias bias =
            analyze(recording_of({{both.begin(), both.begin() + samples}}, 10.0)).axes.at(0).bias;
        return std::abs(bias.value - next) < std::sqrt(2.0) * bias.expanded_uncertainty;
    });
    const auto count = std::ranges::count(covered, true);
    std::printf("covered %td of %zu\n", count, records);
    // Far below 95 %: where a record does not show its random walk, its uncertainty cannot contain it.
    EXPECT_GE(static_cast<double>(count), 0.70 * records);
}

TEST(StaticBias, WithFlickerHasFarFewerEffectiveSamplesThanSamples) {
    const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 100000, 10.0, 5);
    const StaticBias bias = analyze(recording_of({samples}, 10.0)).axes.at(0).bias;
    EXPECT_LT(bias.effective_samples, 2000.0);
    EXPECT_GT(bias.effective_samples, 100.0);
}

TEST(Analyze, ReportsEveryGyroAxisAndOnlyThose) {
    Recording recording = recording_of({std::vector<double>(100, 0.5), std::vector<double>(100, 0.25)}, 10.0);
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
    const AnalysisReport report = analyze(recording_of({std::vector<double>(100, 0.5)}, 10.0), options);
    EXPECT_THAT(report.axes.at(0).curve.points, SizeIs(1));
    EXPECT_THAT(report.warnings, Contains(HasSubstr("m = 51 left out")));
}

TEST(Analyze, GivesTheSameNumbersForAnyNumberOfThreads) {
    std::vector<std::vector<double>> axes;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        axes.push_back(test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 5000, 10.0, seed));
    }
    const Recording recording = recording_of(axes, 10.0);
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
    Recording recording = recording_of({test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 500, 99.3, 1)}, 99.3);
    recording.nominal_rate_hz = 100.0;
    recording.rate_sd_hz = 0.01;
    EXPECT_THAT(analyze(recording).warnings, Contains(HasSubstr("-0.7 % off the nominal 100 Hz")));
    recording.rate_hz = 99.95;
    EXPECT_THAT(analyze(recording).warnings, testing::IsEmpty());
}

TEST(Analyze, OfNothingSaysSo) {
    EXPECT_THAT(analyze(Recording{}).warnings, Contains(HasSubstr("nothing to analyse")));
}

}  // namespace
}  // namespace gyrolog
