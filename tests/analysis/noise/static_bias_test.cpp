#include "analysis/noise/static_bias.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "analysis/noise/analyze.hpp"
#include "tests/analysis/noise/over_seeds.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"
#include "tests/analysis/noise/test_recording.hpp"

namespace gyrolog {
namespace {

// The published measurement: 100 samples at 100 Hz with a standard deviation of 0.1395 dps give (-0.3421 +-
// 0.0279) dps at coverage factor 2. Here the mean over many such records; one alone knows its standard
// deviation to 7 %.
TEST(StaticBias, OfAHundredWhiteSamplesHasThePublishedUncertainty) {
    double mean_uncertainty = 0.0;
    constexpr int records = 40;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        auto samples = test::sensor_noise({0.0, 0.1395 / 10.0, 0.0, 0.0, 0.0}, 100, 100.0, seed);
        for (double& x : samples) { x -= 0.3421; }
        const AnalysisReport report = analyze(test::recording_of({samples}, 100.0));
        mean_uncertainty += report.axes.at(0).bias.expanded_uncertainty / records;
    }
    EXPECT_NEAR(mean_uncertainty, 0.0279, 0.1 * 0.0279);
}

// JCGM 100:2008, table G.2: Student's t for 95.45 %.
TEST(StaticBias, OfAFewSamplesHasStudentsFactor) {
    const auto factor = [](std::vector<double> samples) {
        return analyze(test::recording_of({std::move(samples)}, 1.0)).axes.at(0).bias.coverage_factor;
    };
    EXPECT_NEAR(factor({1.0, 2.0}), 13.97, 0.005);
    EXPECT_NEAR(factor({1.0, 3.0, 2.0}), 4.53, 0.005);
    EXPECT_NEAR(factor({1.0, 3.0, 2.0, 5.0}), 3.31, 0.005);
}

TEST(StaticBias, CoversTheBiasOfTheNextRecordAtCoverageTwo) {
    const std::size_t records = test::realisations(40);
    const auto covered = test::over_seeds(records, [](std::uint64_t seed) {
        const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 40000, 10.0, seed);
        const std::vector<double> first(samples.begin(), samples.begin() + 20000);
        double next = 0.0;
        for (std::size_t i = 20000; i < samples.size(); ++i) { next += samples[i] / 20000.0; }
        const StaticBias bias = analyze(test::recording_of({first}, 10.0)).axes.at(0).bias;
        // Both records have that uncertainty, so their difference has root two of it.
        return std::abs(bias.value - next) < std::sqrt(2.0) * bias.expanded_uncertainty ? 1 : 0;
    });
    const auto count = std::ranges::count(covered, 1);
    std::printf("covered %td of %zu\n", count, records);
    // The uncertainty is itself an estimate.
    const auto number = static_cast<double>(records);
    EXPECT_GE(static_cast<double>(count), 0.95 * number - 3.5 * std::sqrt(0.95 * 0.05 * number));
}

// Two hours with N, B and K, of which K is at the edge of what such a record shows.
TEST(StaticBias, CoversTheNextRecordsBiasWithARandomWalkAsWell) {
    const std::size_t records = test::realisations(20);
    constexpr std::size_t samples = 72'000;
    const auto covered = test::over_seeds(records, [](std::uint64_t seed) {
        const auto both = test::sensor_noise({0.0, 0.01, 0.002, 1e-4, 0.0}, 2 * samples, 10.0, seed);
        double next = 0.0;
        for (std::size_t i = samples; i < both.size(); ++i) { next += both[i] / samples; }
        const StaticBias bias =
            analyze(test::recording_of({{both.begin(), both.begin() + samples}}, 10.0)).axes.at(0).bias;
        return std::abs(bias.value - next) < std::sqrt(2.0) * bias.expanded_uncertainty ? 1 : 0;
    });
    const auto count = std::ranges::count(covered, 1);
    std::printf("covered %td of %zu\n", count, records);
    // Far below 95 %: where a record does not show its random walk, its uncertainty cannot contain it.
    const auto number = static_cast<double>(records);
    EXPECT_GE(static_cast<double>(count), 0.75 * number - 2.0 * std::sqrt(0.75 * 0.25 * number));
}

TEST(StaticBias, WithFlickerHasFarFewerEffectiveSamplesThanSamples) {
    const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 100000, 10.0, 5);
    const StaticBias bias = analyze(test::recording_of({samples}, 10.0)).axes.at(0).bias;
    EXPECT_LT(bias.effective_samples, 2000.0);
    EXPECT_GT(bias.effective_samples, 100.0);
}

}  // namespace
}  // namespace gyrolog
