#include "analysis/noise/outliers.hpp"

#include <random>

#include <gtest/gtest.h>

#include "analysis/noise/converter_step.hpp"

namespace gyrolog {
namespace {

Column gaussian_column(std::size_t samples, double sd) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(3.0, sd);
    std::vector<double> data(samples);
    for (double& x : data) { x = normal(random); }
    return {"gx", "rad/s", data, 0.5, 0.0, "rad_s"};
}

TEST(Outliers, OfGaussianNoiseAreNone) {
    Column column = gaussian_column(200'000, 1.0);
    const std::vector<Segment> whole = {{0, 200'000, 0}};
    EXPECT_EQ(replace_outliers(column, whole).samples, 0U);
}

TEST(Outliers, BecomeTheMedianOfTheirNeighboursAndNothingElseChanges) {
    Column column = gaussian_column(1000, 1.0);
    auto& data = std::get<std::vector<double>>(column.data);
    const std::vector<double> before = data;
    data[0] = 40.0;
    data[500] = -25.0;
    data[501] = 60.0;
    data[999] = 13.0;
    const std::vector<Segment> segments = {{0, 500, 0}, {500, 500, 700}};
    const OutlierCount count = replace_outliers(column, segments);
    EXPECT_EQ(count.samples, 4U);
    EXPECT_NEAR(count.threshold, 6.0 * 0.5, 0.4);
    for (std::size_t i = 0; i < data.size(); ++i) {
        if (i == 0 || i == 500 || i == 501 || i == 999) {
            EXPECT_NEAR(data[i], 3.0, 2.0) << i;
        } else {
            EXPECT_EQ(data[i], before[i]) << i;
        }
    }
}

TEST(Outliers, OfCountsThatHardlyMoveAreLeftAlone) {
    std::vector<std::int16_t> counts(1000, 7);
    counts[10] = 8;
    Column column{"gx", "rad/s", counts, 1.0, 0.0, "lsb"};
    const std::vector<Segment> whole = {{0, 1000, 0}};
    EXPECT_EQ(replace_outliers(column, whole).samples, 0U);
}

TEST(ConverterStep, OfCountsIsTheirScaleAndOfNumbersOnAGridItsStep) {
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal(40.0, 3.0);
    std::vector<std::int16_t> counts(5000);
    std::vector<double> printed(5000);
    std::vector<double> fine(5000);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        fine[i] = normal(random);
        counts[i] = static_cast<std::int16_t>(std::lround(fine[i]));
        printed[i] = std::round(counts[i] / 65.5 * 1e6) / 1e6;
    }
    EXPECT_EQ(converter_step({"gx", "rad/s", counts, 0.25, 0.0, "lsb"}), 0.25);
    EXPECT_NEAR(converter_step({"gx", "rad/s", printed, 2.0, 0.0, "dps"}), 2.0 / 65.5, 1e-6);
    EXPECT_EQ(converter_step({"gx", "rad/s", fine, 1.0, 0.0, "dps"}), 0.0);
}

TEST(ConverterStep, OfNoiseMuchSmallerThanItIsNotUsed) {
    std::vector<std::int16_t> counts(1000, 7);
    for (std::size_t i = 0; i < counts.size(); i += 100) { counts[i] = 8; }
    EXPECT_EQ(converter_step({"gx", "rad/s", counts, 0.25, 0.0, "lsb"}), 0.0);
}

}  // namespace
}  // namespace gyrolog
