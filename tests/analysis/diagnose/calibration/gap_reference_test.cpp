#include "analysis/diagnose/calibration/gap_reference.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/courses.hpp"
#include "analysis/diagnose/measures/repeats.hpp"
#include "analysis/diagnose/measures/spectrum.hpp"

namespace gyrolog {
namespace {

// Curves whose points are normal and hang together.
std::vector<GapCurve> curves_by_chance(std::mt19937_64& random) {
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<GapCurve> curves;
    for (std::size_t c = 0; c < 6; ++c) {
        GapCurve curve{&measures::spectrum, c, c, {}, {}};
        const double common = normal(random);
        for (int i = 0; i < 20; ++i) {
            curve.x.push_back(i);
            curve.value.push_back(3.0 + 0.5 * common + normal(random));
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

TEST(GapReference, HoldsARecordingAndASimulationToTheSameStandard) {
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

// A measure in its own standard deviation is 0 in most simulations, and next to nothing in some: one that has
// what its own scatter is, or less, is no wonder. One that is far off is.
TEST(GapReference, TakesLessThanTheLeastScatterForNoWonder) {
    std::mt19937_64 random(9);
    std::normal_distribution<double> normal(0.0, 1e-4);
    const auto curve_with = [](double value) {
        return std::vector{GapCurve{&measures::repeats, 0, 0, {0.0, 1.0}, {0.0, value}}};
    };
    SimulatedCurves simulated;
    for (int i = 0; i < 30; ++i) { simulated.push_back(curve_with(normal(random))); }
    const GapReference reference = gap_reference(simulated);
    EXPECT_LT(worst_surprise_nats(curve_with(0.5), reference), 2.0);
    EXPECT_GT(worst_surprise_nats(curve_with(8.0), reference), 12.0);
    EXPECT_LT(gap_of(curve_with(0.5).front(), reference, 0).distance, 1.0);
}

TEST(GapReference, LeavesTheOneOutThatItIsAskedTo) {
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

// Curves of three axes, independent points.
std::vector<GapCurve> flat_curves(std::mt19937_64& random, double offset, std::size_t from, std::size_t end) {
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<GapCurve> curves;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        GapCurve curve{&measures::course, axis, axis, {}, {}};
        for (std::size_t i = 0; i < 32; ++i) {
            curve.x.push_back(static_cast<double>(i));
            curve.value.push_back(normal(random) + (i >= from && i < end ? offset : 0.0));
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

GapReference flat_reference(std::mt19937_64& random) {
    SimulatedCurves simulated;
    for (int i = 0; i < 200; ++i) { simulated.push_back(flat_curves(random, 0.0, 0, 0)); }
    return gap_reference(simulated);
}

TEST(GapReference, SeesABroadFrontThatIsLittleAtEveryPoint) {
    std::mt19937_64 random(9);
    const GapReference reference = flat_reference(random);
    const std::vector<GapCurve> curves = flat_curves(random, 3.0, 8, 16);
    const CurveDistance gap = gap_of(curves[0], reference, 0);
    // Eight points, three sigma each: sqrt(8) x 3 together.
    EXPECT_GT(std::ranges::max(gap.window_z), 3.0 * std::sqrt(8.0) - 3.0);
    EXPECT_GT(std::ranges::max(gap.window_z), std::ranges::max(gap.z));
    EXPECT_GT(gap.surprise_nats, 6.0);
}

TEST(GapReference, AddsUpWhatAllAxesShowAtOnePlace) {
    std::mt19937_64 random(10);
    const GapReference reference = flat_reference(random);
    std::vector<GapCurve> curves = flat_curves(random, 0.0, 0, 0);
    for (std::size_t c = 0; c < curves.size(); ++c) {
        curves[c].value[20] = reference.mean[c][20] + 3.0 * reference.sd[c][20];
    }
    const std::vector<double> together = surprises_nats(curves, reference);
    double worst_alone = 0.0;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        worst_alone = std::max(worst_alone, gap_of(curves[c], reference, c).surprise_nats);
    }
    // Half a square of 3.0, less the nats for the places, does not stand out by itself.
    EXPECT_GT(together[0], worst_alone + 2.0);
    EXPECT_EQ(together[0], together[1]);
    EXPECT_EQ(together[0], together[2]);
    EXPECT_EQ(worst_surprise_nats(curves, reference), together[0]);
}

TEST(GapReference, LaysWhatOneAxisShowsToThatAxis) {
    std::mt19937_64 random(12);
    const GapReference reference = flat_reference(random);
    std::vector<GapCurve> curves = flat_curves(random, 0.0, 0, 0);
    curves[0].value[20] += 9.0;
    const std::vector<double> surprises = surprises_nats(curves, reference);
    EXPECT_GT(surprises[0], 15.0);
    EXPECT_EQ(surprises[1], gap_of(curves[1], reference, 1).surprise_nats);
    EXPECT_LT(surprises[1], stands_out_nats(curves));
}

TEST(GapReference, OfThreeAxesHoldsThemToTheSameStandard) {
    constexpr int records = 300;
    std::mt19937_64 random(11);
    int above_all = 0;
    for (int record = 0; record < records; ++record) {
        SimulatedCurves simulated;
        for (int i = 0; i < 30; ++i) { simulated.push_back(flat_curves(random, 0.0, 0, 0)); }
        const double most = std::ranges::max(simulated_surprises_nats(simulated));
        const GapReference reference = gap_reference(simulated);
        above_all += worst_surprise_nats(flat_curves(random, 0.0, 0, 0), reference) > most;
    }
    // 1 of 31, as above.
    EXPECT_NEAR(above_all, records / 31.0, 4.0 * std::sqrt(records / 31.0));
}

}  // namespace
}  // namespace gyrolog
