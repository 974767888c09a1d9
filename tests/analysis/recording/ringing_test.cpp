#include "analysis/recording/ringing.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr std::size_t count = 50;

double squares(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) { sum += value * value; }
    return sum;
}

double squares_about_mean(const std::vector<double>& values) {
    double mean = 0.0;
    for (const double value : values) { mean += value / static_cast<double>(values.size()); }
    double sum = 0.0;
    for (const double value : values) { sum += (value - mean) * (value - mean); }
    return sum;
}

std::vector<double> course(const std::function<double(double)>& value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) { values.push_back(value(static_cast<double>(i))); }
    return values;
}

// At the worst between the points of its grid.
TEST(Ringing, TakesOffAnOscillationThatDiesOut) {
    for (const double onset : {0.0, 7.0, 20.0}) {
        for (const double cycles : {0.012, 0.03, 0.05, 0.078}) {
            for (const double decay : {6.0, 15.0, 40.0}) {
                const std::vector<double> values = course([&](double at) {
                    const double since = at - onset;
                    return 3.0 + (since < 0.0 ? 0.0
                                              : std::exp(-since / decay) *
                                                    std::sin(2.0 * std::numbers::pi * cycles * since + 0.4));
                });
                EXPECT_LT(squares(without_ringing(values)), 0.1 * squares_about_mean(values))
                    << onset << " " << cycles << " " << decay;
            }
        }
    }
}

TEST(Ringing, LeavesAPartOfAPulse) {
    for (const double from : {3.0, 12.0, 24.0}) {
        const std::vector<double> values =
            course([&](double at) { return at >= from && at < from + 17.0 ? 1.0 : 0.0; });
        EXPECT_GT(squares(without_ringing(values)), 0.05 * squares_about_mean(values)) << from;
    }
}

// At any rate the same block in seconds has the same left.
TEST(Ringing, IsTakenOffManyValuesAsOffFew) {
    const auto shape = [](double share) {
        const double since = share - 0.3;
        return since < 0.0 ? 0.0 : std::exp(-since / 0.4) * std::sin(2.0 * std::numbers::pi * 2.1 * since);
    };
    for (const std::size_t many : {std::size_t{25}, std::size_t{100}, std::size_t{2000}}) {
        std::vector<double> values;
        for (std::size_t i = 0; i < many; ++i) {
            values.push_back(shape(static_cast<double>(i) / static_cast<double>(many)));
        }
        EXPECT_LT(squares(without_ringing(values)), 0.1 * squares_about_mean(values)) << many;
    }
}

// Six parameters of fifty values, and the best of a grid.
TEST(Ringing, LeavesMostOfNoise) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int record = 0; record < 20; ++record) {
        const std::vector<double> values = course([&](double) { return normal(random); });
        const double left = squares(without_ringing(values)) / squares_about_mean(values);
        EXPECT_GT(left, 0.5) << record;
        EXPECT_LT(left, 1.0) << record;
    }
}

TEST(Ringing, OfALevelAndOfFewValuesIsTheirMean) {
    EXPECT_NEAR(squares(without_ringing(std::vector<double>(count, 5.0))), 0.0, 1e-20);
    EXPECT_EQ(without_ringing(std::vector<double>{1.0, 2.0, 3.0}), (std::vector<double>{-1.0, 0.0, 1.0}));
    EXPECT_TRUE(without_ringing({}).empty());
}

}  // namespace
}  // namespace gyrolog
