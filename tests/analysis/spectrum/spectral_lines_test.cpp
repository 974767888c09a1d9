#include "analysis/spectrum/spectral_lines.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "analysis/spectrum/line_search.hpp"
#include "tests/analysis/spectrum/coloured_noise.hpp"

namespace gyrolog {
namespace {

using test::Colour;
using test::column_of;
using test::whole;

constexpr double rate_hz = 100.0;

std::vector<SpectralLine> lines_of(const std::vector<double>& x) {
    return find_lines(column_of(x), whole(x.size()), rate_hz);
}

class LinesInNoise : public testing::TestWithParam<Colour> {};

TEST_P(LinesInNoise, AreFoundNoMoreOftenThanStated) {
    constexpr int records = 1500;
    constexpr double stated = 0.1;
    std::mt19937_64 random(12);
    int alarms = 0;
    for (int i = 0; i < records; ++i) {
        const std::vector<double> x = test::coloured_noise(GetParam(), 1000, random);
        const Column column = column_of(x);
        alarms +=
            search_lines(averaged_periodograms(column, whole(x.size()), rate_hz), stated, 1).empty() ? 0 : 1;
    }
    RecordProperty("alarms", alarms);
    const double sd = std::sqrt(records * stated * (1.0 - stated));
    EXPECT_LE(alarms, records * stated + 3.0 * sd);
    // The bound adds up probabilities of places that overlap, and is not to be far off for that.
    EXPECT_GE(alarms, 0.25 * records * stated);
}

INSTANTIATE_TEST_SUITE_P(Colours, LinesInNoise, testing::Values(Colour::white, Colour::flicker, Colour::walk),
                         [](const auto& colour) { return std::string(test::name_of(colour.param)); });

TEST(SpectralLines, ScatterAsTheirStandardDeviationsSay) {
    constexpr int records = 300;
    constexpr double f_hz = 12.3456;
    constexpr double amplitude = 0.3;
    double f_squares = 0.0;
    double amplitude_squares = 0.0;
    for (std::uint64_t seed = 0; seed < records; ++seed) {
        std::vector<double> x = test::white_noise(4000, 100 + seed);
        test::add_sine(x, amplitude, f_hz / rate_hz, 0.02 * static_cast<double>(seed));
        const std::vector<SpectralLine> lines = lines_of(x);
        ASSERT_EQ(lines.size(), 1U) << seed;
        EXPECT_TRUE(lines[0].steady);
        f_squares += std::pow((lines[0].f_hz - f_hz) / lines[0].f_sd_hz, 2);
        amplitude_squares += std::pow((lines[0].amplitude - amplitude) / lines[0].amplitude_sd, 2);
    }
    RecordProperty("f_mean_square", std::to_string(f_squares / records));
    RecordProperty("amplitude_mean_square", std::to_string(amplitude_squares / records));
    // A mean square of 300 scatters by sqrt(2 / 300); the floor is known to some per cent, and the straight
    // line in every block costs a little.
    EXPECT_NEAR(f_squares / records, 1.05, 4.0 * std::sqrt(2.0 / records));
    EXPECT_NEAR(amplitude_squares / records, 1.05, 4.0 * std::sqrt(2.0 / records));
}

// Kay 1993, eq. 3.41: var f = 24 s^2 / (A^2 (2 pi)^2 n (n^2 - 1)) per sample, var A = 2 s^2 / n.
TEST(SpectralLines, StateTheCramerRaoBound) {
    constexpr double n = 20'000.0;
    std::vector<double> x = test::white_noise(20'000, 13);
    test::add_sine(x, 0.5, 0.2);
    const std::vector<SpectralLine> lines = lines_of(x);
    ASSERT_EQ(lines.size(), 1U);
    const double f_sd_hz = std::sqrt(24.0 / (0.25 * n * n * n)) / (2.0 * std::numbers::pi) * rate_hz;
    // The floor beside the line, the mean of 128 bins, is known to 12 per cent, its root to half of that.
    EXPECT_NEAR(lines[0].f_sd_hz / f_sd_hz, 1.0, 0.2);
    EXPECT_NEAR(lines[0].amplitude_sd / std::sqrt(2.0 / n), 1.0, 0.2);
}

TEST(SpectralLines, ThatDriftAreReportedOnce) {
    std::mt19937_64 random(14);
    std::normal_distribution<double> normal;
    std::vector<double> x = test::white_noise(60'000, 15);
    double phase = 0.0;
    double drift_hz = 0.0;
    double mean_hz = 0.0;
    for (double& value : x) {
        // An oscillator that wanders about 31.4 Hz by 0.1 Hz within some seconds.
        drift_hz = 0.998 * drift_hz + 0.1 * std::sqrt(1.0 - 0.998 * 0.998) * normal(random);
        const double f_hz = 31.4 + drift_hz;
        mean_hz += f_hz / 60'000.0;
        phase = std::fmod(phase + 2.0 * std::numbers::pi * f_hz / rate_hz, 2.0 * std::numbers::pi);
        value += 0.5 * std::sin(phase);
    }
    const std::vector<SpectralLine> lines = lines_of(x);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_FALSE(lines[0].steady);
    EXPECT_NEAR(lines[0].f_hz, mean_hz, 4.0 * lines[0].f_sd_hz);
    EXPECT_NEAR(lines[0].amplitude, 0.5, 4.0 * lines[0].amplitude_sd);
    EXPECT_GT(lines[0].width_hz, 0.03);
    EXPECT_LT(lines[0].width_hz, 0.15);
}

TEST(SpectralLines, StrongAndWeakAreBothFound) {
    std::vector<double> x = test::white_noise(50'000, 16);
    test::add_sine(x, 100.0, 0.1);
    test::add_sine(x, 0.2, 0.11);
    test::add_sine(x, 0.1, 0.3);
    const std::vector<SpectralLine> lines = lines_of(x);
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_NEAR(lines[0].f_hz, 10.0, 1e-5);
    EXPECT_NEAR(lines[0].amplitude, 100.0, 0.05);
    EXPECT_NEAR(lines[1].f_hz, 11.0, 4e-3);
    EXPECT_NEAR(lines[1].amplitude, 0.2, 0.03);
    EXPECT_NEAR(lines[2].f_hz, 30.0, 4e-3);
}

TEST(SpectralLines, AreFittedAtTheTrueTimesOfARecordWithHoles) {
    std::vector<double> x = test::white_noise(60'000, 17);
    test::add_sine(x, 0.5, 0.123456);
    const test::Holed holed = test::with_holes(x, 2500, 333);
    const std::vector<SpectralLine> lines = find_lines(holed.column, holed.segments, rate_hz);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].steady);
    EXPECT_NEAR(lines[0].f_hz, 12.3456, 4.0 * lines[0].f_sd_hz);
    EXPECT_LT(lines[0].f_sd_hz, 3e-5);
    EXPECT_NEAR(lines[0].amplitude, 0.5, 4.0 * lines[0].amplitude_sd);
}

TEST(SpectralLines, AreFoundOnBothSidesOfAHoleOfMonths) {
    std::vector<double> x = test::white_noise(20'000, 20);
    test::add_sine(x, 0.5, 0.123456);
    const std::vector<Segment> segments{{0, 10'000, 0}, {10'000, 10'000, 1'000'000'000}};
    const std::vector<SpectralLine> lines = find_lines(column_of(std::move(x)), segments, rate_hz);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(lines[0].f_hz, 12.3456, 0.01);
    EXPECT_NEAR(lines[0].amplitude, 0.5, 0.1);
}

TEST(SpectralLines, StandOnARandomWalk) {
    std::mt19937_64 random(18);
    std::vector<double> x = test::coloured_noise(Colour::walk, 30'000, random);
    test::add_sine(x, 0.5, 0.2);
    const std::vector<SpectralLine> lines = lines_of(x);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(lines[0].f_hz, 20.0, 4.0 * lines[0].f_sd_hz);
    EXPECT_NEAR(lines[0].amplitude, 0.5, 4.0 * lines[0].amplitude_sd);
}

TEST(SpectralLines, OfLowFrequencyComeFromDecimatedSamples) {
    std::vector<double> x = test::white_noise(6 * longest_piece, 19);
    const double f_hz = 40.0 * rate_hz / static_cast<double>(x.size());
    test::add_sine(x, 0.05, f_hz / rate_hz);
    const std::vector<SpectralLine> lines = lines_of(x);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(lines[0].f_hz, f_hz, 4.0 * lines[0].f_sd_hz);
    EXPECT_NEAR(lines[0].amplitude, 0.05, 4.0 * lines[0].amplitude_sd);
}

TEST(SpectralLines, AreNotSeenInNoiseThatComesInBursts) {
    constexpr int records = 100;
    int alarms = 0;
    for (std::uint64_t seed = 0; seed < records; ++seed) {
        std::vector<double> x = test::white_noise(10'000, 500 + seed);
        for (std::size_t i = 4000; i < 4700; ++i) { x[i] *= 30.0; }
        alarms += lines_of(x).empty() ? 0 : 1;
    }
    EXPECT_LE(alarms, 2);
}

TEST(SpectralLines, AreNotSeenInConstantOrVeryShortRecords) {
    EXPECT_TRUE(lines_of(std::vector<double>(5000, 3.0)).empty());
    EXPECT_TRUE(lines_of({}).empty());
    for (std::size_t samples = 1; samples < 70; samples += 4) {
        EXPECT_TRUE(lines_of(test::white_noise(samples, samples)).empty());
    }
}

}  // namespace
}  // namespace gyrolog
