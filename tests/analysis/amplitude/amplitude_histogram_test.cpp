#include "analysis/amplitude/amplitude_histogram.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

Column counts_of(std::vector<std::int16_t> counts, double scale) {
    return {"gx", "rad/s", std::move(counts), scale};
}

std::vector<double> gaussian(std::size_t samples, double mean, double sd, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(mean, sd);
    std::vector<double> x(samples);
    for (double& value : x) { value = normal(random); }
    return x;
}

std::uint64_t total(const AmplitudeHistogram& histogram) {
    return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}

TEST(AmplitudeHistogram, OfFewCountsIsTheirTally) {
    const AmplitudeHistogram histogram = amplitude_histogram(counts_of({3, 5, 5, 6, 3, 5}, 0.5));
    EXPECT_EQ(histogram.samples, 6U);
    EXPECT_DOUBLE_EQ(histogram.mean, 2.25);
    EXPECT_DOUBLE_EQ(histogram.step, 0.5);
    EXPECT_DOUBLE_EQ(histogram.bin_width, 0.5);
    EXPECT_DOUBLE_EQ(histogram.first_edge, 1.25);
    EXPECT_EQ(histogram.counts, (std::vector<std::uint64_t>{2, 0, 3, 1}));
}

// 1, 2, 3, 4 and 10: by hand.
TEST(AmplitudeHistogram, HasTheMomentsOfTheSamples) {
    const AmplitudeHistogram histogram = amplitude_histogram({"gx", "", std::vector<double>{1, 2, 3, 4, 10}});
    EXPECT_DOUBLE_EQ(histogram.mean, 4.0);
    EXPECT_NEAR(histogram.standard_deviation, std::sqrt(50.0 / 4.0), 1e-12);
    EXPECT_NEAR(histogram.skewness, 180.0 / 5.0 / std::pow(10.0, 1.5), 1e-12);
    EXPECT_NEAR(histogram.excess_kurtosis, 1394.0 / 5.0 / 100.0 - 3.0, 1e-12);
}

TEST(AmplitudeHistogram, OfAGaussianIsWhatItExpects) {
    const AmplitudeHistogram histogram = amplitude_histogram({"gx", "", gaussian(100'000, 3.0, 0.2, 1)});
    double chi_square = 0.0;
    double expected_in_all = 0.0;
    int bins = 0;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        const double expected = histogram.expected(i);
        expected_in_all += expected;
        if (expected < 10.0) { continue; }
        chi_square += std::pow(static_cast<double>(histogram.counts[i]) - expected, 2) / expected;
        ++bins;
    }
    EXPECT_NEAR(expected_in_all, 100'000.0, 20.0);
    EXPECT_NEAR(chi_square, bins, 4.0 * std::sqrt(2.0 * bins));
    EXPECT_NEAR(histogram.skewness, 0.0, 4.0 * std::sqrt(6.0 / 1e5));
    EXPECT_NEAR(histogram.excess_kurtosis, 0.0, 4.0 * std::sqrt(24.0 / 1e5));
}

TEST(AmplitudeHistogram, ExpectsTheTailsToTheirLastDigits) {
    AmplitudeHistogram histogram;
    histogram.samples = 1;
    histogram.standard_deviation = 1.0;
    histogram.bin_width = 1.0;
    histogram.first_edge = -11.0;
    // Phi(-10) = 7.6198530241605e-24 (Abramowitz and Stegun, table 26.2 gives -log10 as 23.11805).
    EXPECT_NEAR(histogram.expected(0) / 7.6198530241605e-24, 1.0, 1e-4);
    histogram.first_edge = 10.0;
    EXPECT_NEAR(histogram.expected(0) / 7.6198530241605e-24, 1.0, 1e-4);
}

TEST(AmplitudeHistogram, PutsAsManyStepsIntoEveryBin) {
    std::vector<std::int16_t> counts;
    for (int i = -1000; i < 1000; ++i) { counts.push_back(static_cast<std::int16_t>(i)); }
    const AmplitudeHistogram histogram = amplitude_histogram(counts_of(counts, 0.1), 300);
    EXPECT_DOUBLE_EQ(histogram.bin_width, 0.7);
    ASSERT_LE(histogram.counts.size(), 300U);
    for (std::size_t i = 0; i + 1 < histogram.counts.size(); ++i) { EXPECT_EQ(histogram.counts[i], 7U); }
    EXPECT_EQ(total(histogram), 2000U);
}

TEST(AmplitudeHistogram, FindsTheStepOfCountsPrintedAsReals) {
    std::vector<double> values;
    for (const double value : gaussian(5000, 100.0, 20.0, 2)) {
        // Six decimals of a degree per second, of a converter with 131 counts each.
        values.push_back(std::round(std::round(value) / 131.0 * 1e6) / 1e6);
    }
    EXPECT_NEAR(amplitude_histogram({"gx", "", values}).step, 1.0 / 131.0, 1e-8);
    EXPECT_EQ(amplitude_histogram({"gx", "", gaussian(5000, 100.0, 20.0, 2)}).step, 0.0);
}

TEST(AmplitudeHistogram, OfTheWholeConverterRangeHasEverySample) {
    const AmplitudeHistogram histogram = amplitude_histogram(counts_of({-32768, 32767, 0}, 1.0));
    EXPECT_EQ(total(histogram), 3U);
    EXPECT_EQ(histogram.counts.front(), 1U);
    EXPECT_LE(histogram.counts.size(), 200U);
}

TEST(AmplitudeHistogram, OfAConstantIsOneBin) {
    for (const Column& column : {counts_of({7, 7, 7}, 0.25), Column{"gx", "", std::vector<double>(3, 1.75)},
                                 Column{"gx", "", std::vector<double>(3, 0.0)}}) {
        const AmplitudeHistogram histogram = amplitude_histogram(column);
        EXPECT_EQ(histogram.counts, std::vector<std::uint64_t>{3});
        EXPECT_EQ(histogram.standard_deviation, 0.0);
        EXPECT_EQ(histogram.expected(0), 0.0);
        EXPECT_GT(histogram.bin_width, 0.0);
    }
}

TEST(AmplitudeHistogram, LeavesOutWhatIsNotKnown) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(amplitude_histogram({"gx", "", std::vector<double>{nan, 1.0, nan, 2.0}}).samples, 2U);
    EXPECT_TRUE(amplitude_histogram({"gx", "", std::vector<double>{nan}}).counts.empty());
    EXPECT_TRUE(amplitude_histogram({"gx", "", std::vector<double>{}}).counts.empty());
}

}  // namespace
}  // namespace gyrolog
