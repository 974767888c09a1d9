#include "analysis/noise/contrast_pyramid.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

Column noise_column(std::size_t samples, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(5.0, 2.0);
    std::vector<double> data(samples);
    for (double& x : data) { x = normal(random); }
    return {"gx", "rad/s", data, 1.0, 0.0, "rad_s"};
}

double sum_of_squares(const ContrastPyramid& pyramid) {
    double sum = 0.0;
    for (const ContrastLevel& level : pyramid.levels) {
        // An average of `span` samples has a span-th of their squares.
        for (const double power : level.power) {
            sum += power * static_cast<double>(level.blocks) * static_cast<double>(level.span);
        }
    }
    for (const TopAverage& average : pyramid.top) {
        sum += average.value * average.value * static_cast<double>(pyramid.top_span);
    }
    return sum;
}

TEST(ContrastPyramid, KeepsTheSumOfSquaresOfTheSamples) {
    const Column whole = noise_column(2 * 3 * 1000, 3);
    const std::vector<Segment> segments = {{0, 6000, 0}};
    const ContrastPyramid pyramid = contrast_pyramid(whole, segments, 10.0, 250);
    ASSERT_EQ(6000 % pyramid.top_span, 0);
    const auto& data = std::get<std::vector<double>>(whole.data);
    const double mean = std::accumulate(data.begin(), data.end(), 0.0) / 6000.0;
    double squares = 0.0;
    for (const double x : data) { squares += (x - mean) * (x - mean); }
    EXPECT_NEAR(sum_of_squares(pyramid), squares, 1e-9 * squares);
}

TEST(ContrastPyramid, OfAShortRecordIsTheRecord) {
    const Column column = noise_column(100, 1);
    const std::vector<Segment> segments = {{0, 40, 0}, {40, 60, 50}};
    const ContrastPyramid pyramid = contrast_pyramid(column, segments, 10.0, 256);
    EXPECT_TRUE(pyramid.levels.empty());
    ASSERT_EQ(pyramid.top.size(), 100U);
    EXPECT_EQ(pyramid.top[40].index, 50);
    EXPECT_EQ(pyramid.top_span, 1);
}

TEST(ContrastPyramid, TakesContrastsOfCompleteBlocksOnly) {
    // A hole of one sample costs the one block that it is in.
    const Column column = noise_column(3999, 2);
    const std::vector<Segment> segments = {{0, 1999, 0}, {1999, 2000, 2000}};
    const ContrastPyramid pyramid = contrast_pyramid(column, segments, 10.0, 250);
    ASSERT_EQ(pyramid.levels.size(), 1U);
    EXPECT_EQ(pyramid.levels[0].blocks, 4000 / pyramid.levels[0].length - 1);
    EXPECT_EQ(pyramid.top.size(), static_cast<std::size_t>(4000 / pyramid.levels[0].length));
}

TEST(ContrastPyramid, OfCountsIsThatOfTheirValues) {
    std::vector<std::int16_t> counts(5000);
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(-300.0, 20.0);
    for (auto& x : counts) { x = static_cast<std::int16_t>(std::lround(normal(random))); }
    std::vector<double> values;
    for (const auto x : counts) { values.push_back(x * 0.25); }
    const std::vector<Segment> segments = {{0, 5000, 7}};
    const ContrastPyramid a = contrast_pyramid({"gx", "rad/s", counts, 0.25, 0.0, "lsb"}, segments, 10.0);
    const ContrastPyramid b = contrast_pyramid({"gx", "rad/s", values, 1.0, 0.0, "rad_s"}, segments, 10.0);
    ASSERT_EQ(a.top.size(), b.top.size());
    for (std::size_t i = 0; i < a.top.size(); ++i) { EXPECT_NEAR(a.top[i].value, b.top[i].value, 1e-9); }
    for (std::size_t k = 0; k < a.levels[0].power.size(); ++k) {
        EXPECT_NEAR(a.levels[0].power[k], b.levels[0].power[k], 1e-9 * b.levels[0].power[k]);
    }
}

TEST(CosineContrasts, AreOrthonormalAndCancelAConstant) {
    for (const int length : {2, 7, 16}) {
        const auto rows = cosine_contrasts(length);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            EXPECT_NEAR(std::accumulate(rows[i].begin(), rows[i].end(), 0.0), 0.0, 1e-12);
            for (std::size_t j = 0; j <= i; ++j) {
                EXPECT_NEAR(std::inner_product(rows[i].begin(), rows[i].end(), rows[j].begin(), 0.0),
                            i == j ? 1.0 : 0.0, 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace gyrolog
