#include "analysis/allan/running_allan.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"

namespace gyrolog {
namespace {

// Counts of white noise on a random walk on a bias.
std::vector<std::int16_t> some_counts(std::size_t samples, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<std::int16_t> counts(samples);
    double walk = -4321.0;
    for (std::int16_t& count : counts) {
        walk += 0.2 * normal(random);
        count = static_cast<std::int16_t>(std::lround(walk + 30.0 * normal(random)));
    }
    return counts;
}

RunningAllan run_over(const std::vector<std::int16_t>& counts, const std::vector<Segment>& segments) {
    RunningAllan running;
    for (const Segment& segment : segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            running.take(static_cast<std::int64_t>(segment.first_index) + static_cast<std::int64_t>(i),
                         counts[segment.first + i]);
        }
    }
    return running;
}

double batch(Column column, const std::vector<Segment>& segments, std::int64_t m, DeviationKind kind) {
    AllanOptions options;
    options.kind = kind;
    options.m = {m};
    options.intervals = false;
    const AllanCurve curve = allan_deviation(column, segments, 1.0, options);
    return curve.points.empty() ? 0.0 : curve.points.front().deviation;
}

Column column_of(std::vector<std::int16_t> counts) {
    Column column;
    column.data = std::move(counts);
    return column;
}

// The definition, term by term: differences that begin at every s-th instant of the grid and have all
// samples.
double by_definition(const std::vector<std::int16_t>& counts, const std::vector<Segment>& segments,
                     std::int64_t m, std::int64_t& terms) {
    const std::int64_t s = std::max<std::int64_t>(1, m / 16);
    long double squares = 0.0L;
    terms = 0;
    for (const Segment& segment : segments) {
        const auto first = static_cast<std::int64_t>(segment.first_index);
        const auto end = first + static_cast<std::int64_t>(segment.count);
        for (std::int64_t k = (first + s - 1) / s * s; k + 2 * m <= end; k += s) {
            std::int64_t difference = 0;
            for (std::int64_t i = 0; i < 2 * m; ++i) {
                const std::int64_t count = counts[segment.first + static_cast<std::size_t>(k + i - first)];
                difference += i < m ? -count : count;
            }
            squares += static_cast<long double>(difference) * static_cast<long double>(difference);
            ++terms;
        }
    }
    const auto denominator = 2.0L * static_cast<long double>(m * m) * static_cast<long double>(terms);
    return terms == 0 ? 0.0 : static_cast<double>(std::sqrt(squares / denominator));
}

// Numbers that a board may send; UndefinedBehaviorSanitizer looks on.
TEST(RunningAllan, TakesTheLargestIndexThereIs) {
    RunningAllan running;
    for (std::uint64_t i = 0; i < 100; ++i) {
        const std::uint64_t index =
            static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) - 50 + i;
        running.take(static_cast<std::int64_t>(index), static_cast<std::int16_t>(i % 3));
    }
    EXPECT_EQ(running.samples(), 100U);
    ASSERT_FALSE(running.points(100.0).empty());
    EXPECT_EQ(running.points(100.0).front().terms, 99) << "no hole";
}

TEST(RunningAllan, IsTheOverlappingDeviationUpToSixteenSamples) {
    const auto counts = some_counts(20'000, 1);
    const std::vector<Segment> segments{{0, counts.size(), 0}};
    const auto points = run_over(counts, segments).points(100.0);
    ASSERT_GE(points.size(), 5U);
    for (std::size_t j = 0; j < 5; ++j) {
        EXPECT_EQ(points[j].m, 1 << j);
        EXPECT_DOUBLE_EQ(points[j].tau_s, static_cast<double>(points[j].m) / 100.0);
        const double expected = batch(column_of(counts), segments, points[j].m, DeviationKind::overlapping);
        EXPECT_NEAR(points[j].deviation, expected, 1e-14 * expected) << points[j].m;
        EXPECT_EQ(points[j].terms, static_cast<std::int64_t>(counts.size()) + 1 - 2 * points[j].m);
    }
}

// Above 16 samples it is the batch estimator's of averages of m / 16 samples, at the same averaging time.
TEST(RunningAllan, IsTheOverlappingDeviationOfAveragesAboveSixteenSamples) {
    const auto counts = some_counts(50'000, 2);
    const auto points = run_over(counts, {{0, counts.size(), 0}}).points(1.0);
    ASSERT_EQ(points.back().m, 16'384) << "2 m samples must be there";
    for (const AllanPoint& point : points) {
        if (point.m < 32) { continue; }
        const auto s = static_cast<std::size_t>(point.m / 16);
        std::vector<double> averages(counts.size() / s);
        for (std::size_t i = 0; i < averages.size(); ++i) {
            std::int64_t sum = 0;
            for (std::size_t k = 0; k < s; ++k) { sum += counts[i * s + k]; }
            averages[i] = static_cast<double>(sum) / static_cast<double>(s);
        }
        const std::vector<Segment> whole{{0, averages.size(), 0}};
        Column column;
        column.data = averages;
        const double expected = batch(column, whole, 16, DeviationKind::overlapping);
        EXPECT_NEAR(point.deviation, expected, 1e-9 * expected) << point.m;
        // And it says what the estimator of all differences says: the ones left out hold hardly anything.
        const double every =
            batch(column_of(counts), {{0, counts.size(), 0}}, point.m, DeviationKind::overlapping);
        EXPECT_NEAR(point.deviation, every, 0.01 * every) << point.m;
    }
}

TEST(RunningAllan, HolesCostTheDifferencesThatSpanThem) {
    const auto counts = some_counts(9000, 3);
    // Lost: 1 sample, 700, and 40; the record begins in the middle of the grid.
    const std::vector<Segment> segments{
        {0, 1000, 5}, {1000, 3000, 1006}, {4000, 17, 4706}, {4017, 4983, 4763}};
    const auto points = run_over(counts, segments).points(1.0);
    for (const AllanPoint& point : points) {
        std::int64_t terms = 0;
        const double expected = by_definition(counts, segments, point.m, terms);
        EXPECT_EQ(point.terms, terms) << point.m;
        EXPECT_NEAR(point.deviation, expected, 1e-13 * expected) << point.m;
        if (point.m <= 16) {
            const double all = batch(column_of(counts), segments, point.m, DeviationKind::overlapping);
            EXPECT_NEAR(point.deviation, all, 1e-13 * all) << point.m;
        }
    }
    EXPECT_EQ(points.back().m, 2048) << "the longest stretch has 4983 samples";
}

TEST(RunningAllan, GridThatBeginsAnewIsAHole) {
    const auto counts = some_counts(600, 4);
    RunningAllan running;
    for (std::size_t i = 0; i < 300; ++i) { running.take(static_cast<std::int64_t>(i), counts[i]); }
    for (std::size_t i = 300; i < 600; ++i) { running.take(static_cast<std::int64_t>(i - 300), counts[i]); }
    const auto points = running.points(1.0);
    EXPECT_EQ(running.samples(), 600U);
    EXPECT_EQ(points.front().terms, 2 * 299);
    EXPECT_EQ(points.back().m, 128);
    EXPECT_EQ(points.back().terms, 2 * 6) << "k = 0, 8, ... 40 of each";
}

TEST(RunningAllan, LargestCountsDoNotOverflow) {
    RunningAllan running;
    constexpr std::int64_t half = std::int64_t{1} << 16;
    for (std::int64_t i = 0; i < 4 * half; ++i) {
        running.take(i, static_cast<std::int16_t>((i / half) % 2 == 0 ? 32767 : -32768));
    }
    const auto points = running.points(1.0);
    EXPECT_EQ(points.back().m, 2 * half);
    EXPECT_EQ(points.back().deviation, 0.0) << "averages over whole periods are equal";
    EXPECT_EQ(points[points.size() - 2].m, half);
    // d = +-65535 half at k a multiple of 2 half, down to 0 in between; mean of the squares of a triangle
    // wave in steps of a sixteenth over k = 0 ... 2 half, both ends included.
    double squares = 0.0;
    for (int i = 0; i <= 32; ++i) {
        squares += std::pow(1.0 - std::min(i, 32 - i) / 8.0, 2) * (65535.0 * 65535.0);
    }
    EXPECT_NEAR(points[points.size() - 2].deviation, std::sqrt(squares / 33.0 / 2.0), 1e-6);
}

TEST(RunningAllan, OneSampleHasNoDeviation) {
    RunningAllan running;
    EXPECT_TRUE(running.points(1.0).empty());
    running.take(7, 1);
    EXPECT_TRUE(running.points(1.0).empty());
    running.take(8, 4);
    ASSERT_EQ(running.points(1.0).size(), 1U);
    EXPECT_DOUBLE_EQ(running.points(1.0).front().deviation, 3.0 / std::sqrt(2.0));
}

}  // namespace
}  // namespace gyrolog
