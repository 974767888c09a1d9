#include "analysis/diagnose/gap_measure.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// Curves whose points are normal and hang together.
std::vector<GapCurve> curves_by_chance(std::mt19937_64& random) {
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<GapCurve> curves;
    for (std::size_t c = 0; c < 6; ++c) {
        GapCurve curve{GapDomainKind::spectrum, c, c, {}, {}};
        const double common = normal(random);
        for (int i = 0; i < 20; ++i) {
            curve.x.push_back(i);
            curve.value.push_back(3.0 + 0.5 * common + normal(random));
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

TEST(GapMeasure, HoldsARecordingAndASimulationToTheSameStandard) {
    constexpr std::size_t simulations = 30;
    constexpr int records = 300;
    std::mt19937_64 random(7);
    int above_all = 0;
    int above_half = 0;
    for (int record = 0; record < records; ++record) {
        SimulatedCurves simulated;
        for (std::size_t i = 0; i < simulations; ++i) { simulated.push_back(curves_by_chance(random)); }
        std::vector<double> surprises = simulated_surprises_nats(simulated);
        std::ranges::sort(surprises);
        const double own = worst_surprise_nats(curves_by_chance(random), gap_reference(simulated));
        above_all += own > surprises.back();
        above_half += own > surprises[simulations / 2];
    }
    // Of one more from the same population: 1 of 31 is above all others, 15 of 31 are above the 16th. Held
    // against a mean and scatter of which they were a part themselves, the simulations would lose far more
    // often.
    const auto within = [](int count, double share) {
        return std::fabs(count - records * share) < 4.0 * std::sqrt(records * share * (1.0 - share));
    };
    EXPECT_TRUE(within(above_all, 1.0 / 31.0)) << above_all;
    EXPECT_TRUE(within(above_half, 15.0 / 31.0)) << above_half;
}

TEST(GapMeasure, LeavesTheOneOutThatItIsAskedTo) {
    std::mt19937_64 random(8);
    SimulatedCurves simulated;
    for (int i = 0; i < 12; ++i) { simulated.push_back(curves_by_chance(random)); }
    const GapReference without = gap_reference(simulated, 5);
    simulated.erase(simulated.begin() + 5);
    const GapReference rest = gap_reference(simulated);
    EXPECT_EQ(without.mean, rest.mean);
    EXPECT_EQ(without.sd, rest.sd);
    EXPECT_EQ(without.square_variance, rest.square_variance);
    EXPECT_EQ(without.degrees_of_freedom, 10.0);
}

}  // namespace
}  // namespace gyrolog
