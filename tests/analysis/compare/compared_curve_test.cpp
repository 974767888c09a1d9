#include "analysis/compare/compared_curve.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/compare/axis_curves.hpp"

namespace gyrolog {
namespace {

// Amplitudes of noise whose squares have `dof` degrees of freedom, 1 in the mean square.
class NoisyCurves {
public:
    explicit NoisyCurves(unsigned seed) : random_(seed) {}

    std::vector<double> draw(std::size_t points, double dof) {
        std::chi_squared_distribution<double> chi_square(dof);
        std::vector<double> values(points);
        for (double& value : values) { value = std::sqrt(chi_square(random_) / dof); }
        return values;
    }

private:
    std::mt19937 random_;
};

std::vector<double> places(std::size_t points) {
    std::vector<double> at(points);
    for (std::size_t i = 0; i < points; ++i) { at[i] = static_cast<double>(i + 1); }
    return at;
}

TEST(SimulationBand, HoldsExactly95PercentBetweenTheExtremesOf39) {
    EXPECT_EQ(band_rank(39), 1U);
    EXPECT_DOUBLE_EQ(band_probability(39), 0.95);
    EXPECT_DOUBLE_EQ(band_probability(40), 1.0 - 2.0 / 41.0);
    EXPECT_EQ(band_rank(78), 1U);
    EXPECT_EQ(band_rank(79), 2U);
    EXPECT_DOUBLE_EQ(band_probability(79), 0.95);
    EXPECT_DOUBLE_EQ(band_probability(9), 0.8);
}

TEST(SimulationBand, LeavesOutAsManyPointsAsItSays) {
    for (const std::size_t simulations : {20U, 40U, 100U}) {
        constexpr std::size_t points = 20'000;
        NoisyCurves noise(1);
        std::vector<std::vector<double>> simulated;
        for (std::size_t i = 0; i < simulations; ++i) { simulated.push_back(noise.draw(points, 3.0)); }
        const ComparedCurve curve =
            compare_with_simulations(places(points), noise.draw(points, 3.0), simulated);
        const double share = 1.0 - band_probability(simulations);
        EXPECT_NEAR(curve.points_by_chance, share * points, 1e-9);
        EXPECT_NEAR(static_cast<double>(curve.points_outside()), share * points,
                    5.0 * std::sqrt(share * points));
    }
}

TEST(SimulationBand, LittleStandsOutOfCurvesThatAreAlike) {
    int stands_out = 0;
    for (unsigned trial = 0; trial < 300; ++trial) {
        NoisyCurves noise(trial);
        std::vector<std::vector<double>> simulated;
        for (int i = 0; i < 40; ++i) { simulated.push_back(noise.draw(60, 4.0)); }
        const ComparedCurve curve = compare_with_simulations(places(60), noise.draw(60, 4.0), simulated);
        stands_out += curve.gap.stands_out ? 1 : 0;
    }
    // One in twenty: 15 of 300 points that do not vary together, and their scatter.
    EXPECT_NEAR(stands_out, 15, 3 * 4);
}

TEST(ComparedCurve, SaysWhereTheRecordingLiesOutsideAndByHowMuch) {
    NoisyCurves noise(3);
    std::vector<std::vector<double>> simulated;
    for (int i = 0; i < 40; ++i) { simulated.push_back(noise.draw(50, 1000.0)); }
    std::vector<double> recording(50, 1.0);
    for (std::size_t i = 10; i < 15; ++i) { recording[i] = 2.0; }
    recording[12] = 3.0;
    for (std::size_t i = 15; i < 18; ++i) { recording[i] = 0.5; }
    const ComparedCurve curve = compare_with_simulations(places(50), recording, simulated);
    ASSERT_EQ(curve.outside.size(), 2U);
    EXPECT_EQ(curve.outside[0].from, 11.0);
    EXPECT_EQ(curve.outside[0].to, 15.0);
    EXPECT_EQ(curve.outside[0].worst_at, 13.0);
    EXPECT_EQ(curve.outside[0].points, 5U);
    // The median of 40 has a standard error of 1.25 / sqrt(2 * 1000 * 40), 0.04 dB.
    EXPECT_NEAR(curve.outside[0].worst_dB, 20.0 * std::log10(3.0), 0.2);
    EXPECT_EQ(curve.outside[1].from, 16.0);
    EXPECT_NEAR(curve.outside[1].worst_dB, -20.0 * std::log10(2.0), 0.2);
    EXPECT_EQ(curve.gap.at, 13.0);
    EXPECT_TRUE(curve.gap.stands_out);
    EXPECT_EQ(curve.simulations_outside_as_often, 0U);
}

TEST(ComparedCurve, ASmallGapWhereNoiseIsLowIsNotHiddenByThePointsWhereItIsHigh) {
    NoisyCurves noise(4);
    const auto draw = [&] {
        std::vector<double> values = noise.draw(100, 2.0);
        const std::vector<double> quiet = noise.draw(100, 10'000.0);
        values.insert(values.end(), quiet.begin(), quiet.end());
        return values;
    };
    std::vector<std::vector<double>> simulated;
    for (int i = 0; i < 40; ++i) { simulated.push_back(draw()); }
    std::vector<double> recording = draw();
    recording[150] = 1.0 + 8.0 / std::sqrt(2.0 * 10'000.0);  // 8 standard deviations, 0.5 dB
    const ComparedCurve curve = compare_with_simulations(places(200), recording, simulated);
    EXPECT_EQ(curve.gap.at, 151.0);
    EXPECT_TRUE(curve.gap.stands_out);
    EXPECT_NEAR(curve.gap.dB, 0.48, 0.1);
}

TEST(ComparedCurve, LeavesOutPointsWithoutAPositiveValue) {
    const std::vector<std::vector<double>> simulated{{1.0, 1.0, 1.0}, {1.1, 0.0, 1.1}, {1.2, 1.2, 1.2}};
    const ComparedCurve curve =
        compare_with_simulations(places(3), std::vector<double>{1.0, 1.0, 0.0}, simulated);
    EXPECT_EQ(curve.at, std::vector<double>{1.0});
}

TEST(ComparedCurve, TwoRecordingsAreApartWhereTheirIntervalsDoNotMeet) {
    const CurveWithInterval first{{1, 2, 4, 8}, {1, 1, 1, 1}, {0.9, 0.9, 0.9, 0.9}, {1.1, 1.1, 1.1, 1.1}};
    const CurveWithInterval second{{1, 4}, {1.15, 2.0}, {1.05, 1.8}, {1.25, 2.2}};
    const ComparedCurve curve = compare_with_intervals(first, second);
    ASSERT_EQ(curve.at, (std::vector<double>{1, 2, 4}));  // 8 is beyond the second
    EXPECT_NEAR(curve.other[1], std::sqrt(1.15 * 2.0), 1e-12);
    ASSERT_EQ(curve.outside.size(), 1U);
    EXPECT_EQ(curve.outside[0].from, 2.0);
    EXPECT_EQ(curve.outside[0].to, 4.0);
    EXPECT_NEAR(curve.outside[0].worst_dB, -20.0 * std::log10(2.0), 1e-9);
}

TEST(ComparedCurve, IntervalsOfEqualCurvesAreApartAsOftenAsChanceHasIt) {
    constexpr std::size_t points = 20'000;
    constexpr double dof = 400.0;
    NoisyCurves noise(5);
    const auto with_interval = [&] {
        CurveWithInterval curve{places(points), noise.draw(points, dof), {}, {}};
        const double spread = std::exp(1.0 / std::sqrt(2.0 * dof));  // one standard deviation
        for (const double value : curve.value) {
            curve.lo.push_back(value / spread);
            curve.hi.push_back(value * spread);
        }
        return curve;
    };
    const ComparedCurve curve = compare_with_intervals(with_interval(), with_interval());
    EXPECT_NEAR(static_cast<double>(curve.points_outside()), curve.points_by_chance,
                5.0 * std::sqrt(curve.points_by_chance));
    EXPECT_NEAR(curve.points_by_chance, 0.1573 * points, 0.5);
}

TEST(Interpolated, FollowsAPowerLawExactlyAndEndsWithThePoints) {
    const std::vector<double> x{1.0, 10.0, 1000.0};
    const std::vector<double> y{8.0, 0.8, 0.008};
    EXPECT_NEAR(interpolated(x, y, 2.0), 4.0, 1e-12);
    EXPECT_NEAR(interpolated(x, y, 100.0), 0.08, 1e-12);
    EXPECT_EQ(interpolated(x, y, 10.0), 0.8);
    EXPECT_TRUE(std::isnan(interpolated(x, y, 0.5)));
    EXPECT_TRUE(std::isnan(interpolated(x, y, 1001.0)));
}

}  // namespace
}  // namespace gyrolog
