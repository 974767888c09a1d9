#include "analysis/spectrum/power_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "analysis/spectrum/decimator.hpp"
#include "tests/analysis/spectrum/coloured_noise.hpp"

namespace gyrolog {
namespace {

using std::numbers::pi;
using test::Colour;
using test::column_of;
using test::whole;

constexpr double rate_hz = 100.0;
// More than two of the longest pieces: the lower frequencies come from decimated samples.
constexpr std::size_t long_record = 5 * longest_piece;

PowerSpectrum spectrum_of(const std::vector<double>& x, const SpectrumOptions& options = {}) {
    return power_spectrum(column_of(x), whole(x.size()), rate_hz, options);
}

double variance_of(const std::vector<double>& x) {
    const auto n = static_cast<double>(x.size());
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double squares = 0.0;
    for (const double value : x) { squares += (value - mean) * (value - mean); }
    return squares / n;
}

double power_between(const PowerSpectrum& spectrum, double lo_hz, double hi_hz) {
    double power = 0.0;
    for (const SpectrumPoint& p : spectrum.points) {
        if (p.f_hz >= lo_hz && p.f_hz < hi_hz) { power += 2.0 * p.density * p.width_hz; }
    }
    return power;
}

// Mean over the points between two frequencies of estimate over truth, weighted by their degrees of freedom,
// and its standard deviation.
template <typename Truth>
void expect_level(const PowerSpectrum& spectrum, double lo_hz, double hi_hz, Truth&& truth) {
    double sum = 0.0;
    double dof = 0.0;
    for (const SpectrumPoint& p : spectrum.points) {
        if (p.f_hz < lo_hz || p.f_hz >= hi_hz) { continue; }
        sum += p.dof * p.density / truth(p.f_hz);
        dof += p.dof;
    }
    ASSERT_GT(dof, 0.0);
    EXPECT_NEAR(sum / dof, 1.0, 4.0 * std::sqrt(2.0 / dof)) << lo_hz << " ... " << hi_hz << " Hz";
}

TEST(PowerSpectrum, OfWhiteNoiseIsItsNSquaredAtEveryFrequency) {
    const PowerSpectrum spectrum = spectrum_of(test::white_noise(long_record, 1));
    for (double f_hz = 0.002; f_hz < rate_hz / 2.0; f_hz *= 4.0) {
        expect_level(spectrum, f_hz, 4.0 * f_hz, [](double) { return 1.0 / rate_hz; });
    }
}

TEST(PowerSpectrum, IntervalsHoldTheTruthAsOftenAsTheySay) {
    int inside = 0;
    int points = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        for (const SpectrumPoint& p : spectrum_of(test::white_noise(5000, seed)).points) {
            inside += p.lo <= 1.0 / rate_hz && p.hi >= 1.0 / rate_hz;
            ++points;
        }
    }
    // Neighbouring points share what the taper spreads: half of them count as independent.
    const double share = static_cast<double>(inside) / points;
    RecordProperty("share", std::to_string(share));
    EXPECT_NEAR(share, 0.683, 4.0 * std::sqrt(0.683 * 0.317 / (0.5 * points)));
}

TEST(PowerSpectrum, DegreesOfFreedomAreThoseOfTheScatter) {
    std::vector<double> sums, squares, dof;
    constexpr int records = 200;
    for (std::uint64_t seed = 0; seed < records; ++seed) {
        const PowerSpectrum spectrum = spectrum_of(test::white_noise(3000, 1000 + seed));
        sums.resize(spectrum.points.size());
        squares.resize(spectrum.points.size());
        dof.resize(spectrum.points.size());
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i] += spectrum.points[i].density;
            squares[i] += std::pow(spectrum.points[i].density, 2);
            dof[i] = spectrum.points[i].dof;
        }
    }
    double ratio = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double mean = sums[i] / records;
        ratio += (squares[i] / records - mean * mean) / (mean * mean) * dof[i] / 2.0;
    }
    ratio /= static_cast<double>(sums.size());
    // A variance from 200 records scatters by a tenth, more for few degrees of freedom; half of the points
    // are independent.
    EXPECT_NEAR(ratio, 1.0, 4.0 * 0.15 / std::sqrt(0.5 * static_cast<double>(sums.size())));
}

TEST(PowerSpectrum, IntegratesToTheVariance) {
    for (const std::size_t samples : {std::size_t{1000}, std::size_t{20'000}, long_record}) {
        const std::vector<double> x = test::white_noise(samples, 2);
        const double variance = variance_of(x);
        // The lowest bins are left out; taper and overlap weight the samples unevenly, and bands are not of
        // the same pieces, which moves the sum by about sqrt(2 / samples).
        const auto n = static_cast<double>(samples);
        EXPECT_NEAR(power_between(spectrum_of(x), 0.0, rate_hz) / variance, 1.0,
                    4.0 / n + 4.0 * std::sqrt(2.0 / n));
    }
}

TEST(PowerSpectrum, OfARandomWalkFallsByTheSquareUpToHalfTheRate) {
    std::mt19937_64 random(3);
    const std::vector<double> x = test::coloured_noise(Colour::walk, long_record, random);
    const PowerSpectrum spectrum = spectrum_of(x);
    // Of a sum of white noise: 1 / (rate 4 sin^2(pi f / rate)).
    const auto truth = [](double f_hz) {
        return 1.0 / (rate_hz * 4.0 * std::pow(std::sin(pi * f_hz / rate_hz), 2));
    };
    for (double f_hz = 0.005; f_hz < rate_hz / 2.0; f_hz *= 4.0) {
        expect_level(spectrum, f_hz, 4.0 * f_hz, truth);
    }
}

// Where the bands' periodogram changes, a part of a line's lobe may be in both or in neither.
TEST(PowerSpectrum, HoldsASineAsHalfItsSquaredAmplitude) {
    constexpr int lines = 20;
    int off = 0;
    for (int i = 0; i < lines; ++i) {
        const double f_hz = 0.03 * std::pow(1000.0, (i + 0.5) / lines);
        std::vector<double> x(long_record, 0.0);
        test::add_sine(x, 3.0, f_hz / rate_hz);
        const double power = power_between(spectrum_of(x), 0.8 * f_hz, 1.25 * f_hz);
        off += std::abs(power - 4.5) > 0.045 ? 1 : 0;
        EXPECT_NEAR(power, 4.5, 2.25) << f_hz;
    }
    EXPECT_LE(off, lines / 10);
}

TEST(PowerSpectrum, IgnoresABias) {
    std::vector<double> x = test::white_noise(20'000, 4);
    const PowerSpectrum without = spectrum_of(x);
    for (double& value : x) { value += 1e6; }
    const PowerSpectrum with = spectrum_of(x);
    ASSERT_EQ(with.points.size(), without.points.size());
    for (std::size_t i = 0; i < with.points.size(); ++i) {
        EXPECT_NEAR(with.points[i].density, without.points[i].density, 1e-6 * without.points[i].density);
    }
}

TEST(PowerSpectrum, OfCountsIsThatOfTheSameNumbersAsReals) {
    Column counts{"gx", "rad/s", std::vector<std::int16_t>(), 0.25};
    std::vector<double> values;
    for (const double value : test::white_noise(30'000, 5)) {
        const auto count = static_cast<std::int16_t>(std::lround(40.0 * value) + 700);
        std::get<std::vector<std::int16_t>>(counts.data).push_back(count);
        values.push_back(0.25 * count);
    }
    const PowerSpectrum of_counts = power_spectrum(counts, whole(values.size()), rate_hz);
    const PowerSpectrum of_reals = spectrum_of(values);
    ASSERT_EQ(of_counts.points.size(), of_reals.points.size());
    for (std::size_t i = 0; i < of_reals.points.size(); ++i) {
        EXPECT_NEAR(of_counts.points[i].density / of_reals.points[i].density, 1.0, 1e-9);
    }
}

TEST(PowerSpectrum, KeepsItsLevelWithHoles) {
    for (const std::size_t kept : {300U, 5000U}) {
        const test::Holed holed = test::with_holes(test::white_noise(200'000, 6), kept, 77);
        const PowerSpectrum spectrum = power_spectrum(holed.column, holed.segments, rate_hz);
        ASSERT_FALSE(spectrum.points.empty());
        // Two periods in the longest segment.
        EXPECT_NEAR(spectrum.points.front().f_hz, 2.0 * rate_hz / static_cast<double>(kept),
                    0.1 * rate_hz / static_cast<double>(kept));
        expect_level(spectrum, 0.0, 1.0, [](double) { return 1.0 / rate_hz; });
        expect_level(spectrum, 1.0, rate_hz, [](double) { return 1.0 / rate_hz; });
    }
}

TEST(PowerSpectrum, UsesShortSegmentsWhereTheyResolveEnough) {
    // One long segment and many short ones: high frequencies are known from all, low ones from the long one.
    std::vector<double> x = test::white_noise(100'000, 7);
    std::vector<Segment> segments{{0, 20'000, 0}};
    for (std::size_t first = 20'000; first < x.size(); first += 400) {
        segments.push_back({first, 400, static_cast<std::int64_t>(first + first / 400)});
    }
    const PowerSpectrum spectrum = power_spectrum(column_of(std::move(x)), segments, rate_hz);
    // The lowest band starts with two periods in the long segment, and has the bins it needs.
    const SpectrumPoint& lowest = spectrum.points.front();
    const double bin_hz = rate_hz / 20'000.0;
    EXPECT_LT(lowest.f_hz - 0.5 * lowest.width_hz, 2.0 * bin_hz);
    EXPECT_GE(lowest.dof, SpectrumOptions().least_dof);
    const SpectrumPoint& last = spectrum.points.back();
    // Bins of the whole record in that band, two degrees of freedom each; overlapped Hann pieces keep nine
    // tenths of them.
    EXPECT_GT(last.dof, 0.8 * 2.0 * last.width_hz * 100'000.0 / rate_hz);
}

TEST(PowerSpectrum, KnowsLessOfNoiseThatComesInABurst) {
    std::vector<double> x = test::white_noise(50'000, 11);
    const double even = spectrum_of(x).points.back().dof;
    for (std::size_t i = 20'000; i < 25'000; ++i) { x[i] *= 100.0; }
    const double uneven = spectrum_of(x).points.back().dof;
    EXPECT_NEAR(uneven / even, 0.1, 0.03);
}

TEST(PowerSpectrum, HoldsALineOnceWhereItGoesOverToDecimatedSamples) {
    std::vector<double> x = test::white_noise(long_record, 8);
    const double f_hz = 0.25 * rate_hz / Decimator::factor;
    test::add_sine(x, 10.0, f_hz / rate_hz);
    // A fifth may be lost where the taper spreads it across the edge of a band of another resolution.
    EXPECT_NEAR(power_between(spectrum_of(x), 0.7 * f_hz, 1.4 * f_hz), 50.0, 10.0);
}

TEST(PowerSpectrum, HasNoPointsForFewerThanSixteenSamples) {
    EXPECT_TRUE(spectrum_of(test::white_noise(15, 9)).points.empty());
    EXPECT_FALSE(spectrum_of(test::white_noise(16, 9)).points.empty());
    EXPECT_TRUE(power_spectrum(column_of({}), {}, rate_hz).points.empty());
}

TEST(PowerSpectrum, OfAConstantIsZero) {
    for (const SpectrumPoint& p : spectrum_of(std::vector<double>(1000, 5.0)).points) {
        EXPECT_EQ(p.density, 0.0);
        EXPECT_EQ(p.lo, 0.0);
        EXPECT_EQ(p.hi, 0.0);
    }
}

TEST(Decimator, StopsWhatWouldFoldOntoItsOutputs) {
    for (double f = 0.7; f < 4.0; f += 0.1) {  // cycles per output
        std::vector<double> in(4000);
        test::add_sine(in, 1.0, f / Decimator::factor);
        std::vector<double> out;
        Decimator().push(in, out);
        const double most = std::ranges::max(out, {}, [](double value) { return std::abs(value); });
        EXPECT_LT(std::abs(most), std::pow(10.0, -90.0 / 20.0)) << f;
    }
}

TEST(Decimator, PassesASineWithItsStatedGain) {
    for (const double f : {0.01, 0.1, 0.25, 0.3}) {
        std::vector<double> in(8 * 20'000);
        test::add_sine(in, 1.0, f / Decimator::factor);
        std::vector<double> out;
        Decimator().push(in, out);
        EXPECT_EQ(out.size(), Decimator::outputs(in.size()));
        EXPECT_NEAR(2.0 * variance_of(out), Decimator::power_gain(f), 1e-3);
    }
}

TEST(Decimator, GivesTheSameInPiecesAsInOne) {
    const std::vector<double> in = test::white_noise(5000, 10);
    std::vector<double> at_once, some, in_pieces;
    Decimator().push(in, at_once);
    Decimator decimator;
    for (std::size_t first = 0; first < in.size(); first += 333) {
        decimator.push(std::span(in).subspan(first, std::min<std::size_t>(333, in.size() - first)), some);
        in_pieces.insert(in_pieces.end(), some.begin(), some.end());
    }
    EXPECT_EQ(in_pieces, at_once);
}

}  // namespace
}  // namespace gyrolog
