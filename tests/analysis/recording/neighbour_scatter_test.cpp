#include "analysis/recording/neighbour_scatter.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double sd = 0.3;

Column column_of(std::vector<double> values) {
    return {"ref_x", "rad/s", std::move(values), 1.0, 0.0, "", {}};
}

Column noise_on(double slope, double swing) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal(0.0, sd);
    std::vector<double> values;
    for (int i = 0; i < 20'000; ++i) {
        values.push_back(normal(random) + slope * i + swing * std::sin(0.05 * i));
    }
    return column_of(std::move(values));
}

const std::vector<Segment> whole = {{0, 20'000, 0}};

TEST(NeighbourScatter, IsThatOfWhiteNoiseByDifferencesOfAnyOrder) {
    const Column noise = noise_on(0.0, 0.0);
    for (const std::size_t order : {1U, 2U, 3U}) {
        EXPECT_NEAR(neighbour_scatter(noise, whole, order) / sd, 1.0, 0.03) << "order " << order;
    }
}

// Of 2000 records of 200 samples; a variance of as many is known to sqrt(2 / 2000), 3 %.
TEST(NeighbourScatter, HasTheVarianceThatIsStated) {
    constexpr std::size_t records = 2000;
    constexpr std::size_t rows = 200;
    std::mt19937_64 random(12);
    std::normal_distribution<double> normal;
    for (const auto& [order, factor] : {std::pair<std::size_t, double>{1, 3.0}, {3, 4.6}}) {
        double sum = 0.0;
        for (std::size_t record = 0; record < records; ++record) {
            std::vector<double> values(rows);
            for (double& value : values) { value = normal(random); }
            const double scatter =
                neighbour_scatter(column_of(std::move(values)), std::vector<Segment>{{0, rows, 0}}, order);
            sum += (scatter * scatter - 1.0) * (scatter * scatter - 1.0);
        }
        const double variance = sum / static_cast<double>(records);
        EXPECT_NEAR(variance * static_cast<double>(rows - order) / factor, 1.0, 0.15) << "order " << order;
    }
}

TEST(NeighbourScatter, LosesWhatIsSlowTheMoreTheHigherTheOrder) {
    const Column moved = noise_on(1.0, 20.0);
    EXPECT_GT(neighbour_scatter(moved, whole), 3.0 * sd);
    EXPECT_NEAR(neighbour_scatter(moved, whole, 3) / sd, 1.0, 0.03);
}

// By hand: 1, 2, 4 have the differences 1 and 2, and one of the second order, 1, whose coefficients are 1,
// -2, 1.
TEST(NeighbourScatter, IsTheMeanSquareOverTheSquaresOfTheCoefficients) {
    const Column column = column_of({1.0, 2.0, 4.0});
    const std::vector<Segment> rows = {{0, 3, 0}};
    EXPECT_DOUBLE_EQ(neighbour_scatter(column, rows), std::sqrt(2.5 / 2.0));
    EXPECT_DOUBLE_EQ(neighbour_scatter(column, rows, 2), std::sqrt(1.0 / 6.0));
    EXPECT_EQ(neighbour_scatter(column, rows, 3), 0.0) << "too short";
}

TEST(NeighbourScatter, LeavesOutWhatIsNotKnownAndWhatIsNoNeighbour) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Column column = column_of({1.0, unknown, 5.0, 7.0, 100.0});
    EXPECT_DOUBLE_EQ(neighbour_scatter(column, std::vector<Segment>{{0, 4, 0}, {4, 1, 10}}),
                     std::sqrt(4.0 / 2.0));
}

}  // namespace
}  // namespace gyrolog
