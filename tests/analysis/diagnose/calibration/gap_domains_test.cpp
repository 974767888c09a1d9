#include "analysis/diagnose/calibration/gap_domains.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/gap_places.hpp"
#include "analysis/diagnose/measures/allan.hpp"
#include "analysis/diagnose/measures/amplitude.hpp"
#include "analysis/diagnose/measures/courses.hpp"
#include "analysis/diagnose/measures/noise_level.hpp"
#include "analysis/diagnose/measures/reference_rate.hpp"
#include "analysis/diagnose/measures/spectrum.hpp"

namespace gyrolog {
namespace {

// Of simulations whose numbers have the mean 0.1 and a standard deviation of 0.02 at every point.
GapReference reference_of(const std::vector<GapCurve>& curves) {
    GapReference reference;
    reference.degrees_of_freedom = 199.0;
    for (const GapCurve& curve : curves) {
        const std::size_t points = curve.value.size();
        reference.mean.emplace_back(points, 0.1);
        reference.sd.emplace_back(points, 0.02);
        reference.rms_scale.push_back(1.0);
        reference.square_mean.push_back(static_cast<double>(points));
        reference.square_variance.push_back(2.0 * static_cast<double>(points));
    }
    return reference;
}

TEST(GapDomains, AreInUnitsThatPeopleUse) {
    const std::vector<GapCurve> curves = {
        {&measures::allan, 1, 1, {1.0, 2.0}, {0.1, 0.2}},
        {&measures::spectrum, 0, 0, {1.0, 2.0}, {3.0 * (std::cbrt(2.0) - 1.0), 0.0}},
        {&measures::course, 0, 0, {10.0, 20.0}, {std::log(2.0), 0.0}},
        {&measures::rate, 0, 2, {-1.0, 1.0}, {0.1, 0.1}},
        {&measures::amplitude, 0, 0, {2.0, 3.0}, {0.1, 0.1}},
    };
    const GapReference reference = reference_of(curves);
    const std::vector<GapDomain> domains = gap_domains({curves, reference}, nullptr, 0.95);
    ASSERT_EQ(domains.size(), curves.size());
    EXPECT_EQ(domains[0].axis, 1U);
    EXPECT_NEAR(domains[0].recording[1], std::exp(0.2) * deg_per_rad, 1e-12);
    EXPECT_NEAR(domains[0].before_hi[0], std::exp(0.1 + 1.96 * 0.02) * deg_per_rad, 1e-4);
    EXPECT_EQ(domains[0].outside_before, (std::vector<bool>{false, true}));
    EXPECT_NEAR(domains[1].recording[0], 10.0 * std::log10(2.0), 1e-9);
    EXPECT_NEAR(domains[2].recording[0], 10.0 * std::log10(2.0), 1e-9);
    EXPECT_EQ(domains[3].name, "rate about z");
    EXPECT_NEAR(domains[3].x[1], deg_per_rad, 1e-12);
    EXPECT_EQ(domains[4].x.size(), 2U);
    EXPECT_NEAR(domains[4].recording[1], 0.0, 1e-12);
    EXPECT_NEAR(domains[4].before_hi[1], 1.96 * 0.02, 1e-5);
    EXPECT_TRUE(domains[0].after_lo.empty());
    // Five standard deviations at a point, and none.
    EXPECT_TRUE(domains[0].stands_out);
    EXPECT_FALSE(domains[3].stands_out);
}

TEST(GapDomains, ShowTheCorrectedModelsBandAsSeenFromTheRecording) {
    const std::vector<GapCurve> before = {{&measures::drift, 0, 0, {1.0, 2.0}, {5.0, 0.1}}};
    const std::vector<GapCurve> after = {{&measures::drift, 0, 0, {1.0, 2.0}, {0.11, 0.3}}};
    const GapReference reference = reference_of(before);
    const JudgedCurves corrected{after, reference};
    const GapDomain domain = gap_domains({before, reference}, &corrected, 0.95).at(0);
    EXPECT_EQ(domain.outside_before, (std::vector<bool>{true, false}));
    EXPECT_EQ(domain.outside_after, (std::vector<bool>{false, true}));
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(domain.recording[i] - domain.after_lo[i], after[0].value[i] - (0.1 - 1.96 * 0.02), 1e-5);
    }
    EXPECT_GT(domain.gap_before, domain.gap_after);
}

TEST(GapDomains, OfAllAxesSayThatTheyAre) {
    GapCurve own{&measures::memory, 1, 1, {1.0, 2.0}, {0.1, 0.1}};
    GapCurve shared = own;
    shared.of_all_axes = true;
    const std::vector<GapCurve> curves = {own, shared};
    const GapReference reference = reference_of(curves);
    const std::vector<GapDomain> domains = gap_domains({curves, reference}, nullptr, 0.95);
    EXPECT_EQ(domains[0].axis_text(), "y");
    EXPECT_EQ(domains[0].name, "bursts of noise");
    EXPECT_EQ(domains[1].axis_text(), "all");
    EXPECT_EQ(domains[1].name, "shared bursts of noise");
}

// One number for all sizes.
TEST(GapPlaces, SaysNoAmplitudeWhereTheGapIsASkewness) {
    const std::vector<GapCurve> curves = {
        {&measures::amplitude, 1, 1, {2.0, 3.0}, {0.1, 0.1}},
        {&measures::skewness, 1, 1, {0.0}, {5.0}},
    };
    GapReference reference = reference_of(curves);
    reference.window_sd.assign(curves.size(), {});
    const Place where = farthest_place(curves, reference);
    EXPECT_EQ(where.axes, std::vector<std::size_t>{1});
    EXPECT_FALSE(where.amplitude_sigma);
}

// Its multiples and parts stand out with it; and it is seen on all axes together.
TEST(GapPlaces, SaysTheBestPeriodOfARhythmAndAllAxes) {
    GapCurve rhythm{&measures::rhythm, 0, 0, {20.0, 40.0, 80.0}, {0.4, 0.9, 0.3}};
    rhythm.of_all_axes = true;
    const std::vector<GapCurve> curves = {{&measures::drift, 0, 0, {1.0, 2.0, 3.0}, {0.1, 0.1, 0.1}},
                                          {&measures::drift, 2, 2, {1.0, 2.0, 3.0}, {0.1, 0.1, 0.1}},
                                          rhythm};
    GapReference reference = reference_of(curves);
    reference.window_sd.assign(curves.size(), {});
    const Place where = farthest_place(curves, reference);
    EXPECT_EQ(where.axes, (std::vector<std::size_t>{0, 2}));
    ASSERT_TRUE(where.tau_s.has_value());
    EXPECT_EQ(where.tau_s->from, 40.0);
    EXPECT_EQ(where.tau_s->to, 40.0);
}

// One place for each measure, the largest first; what does not stand out is none.
TEST(GapPlaces, AreThoseThatStandOutByMeasure) {
    const std::vector<GapCurve> curves = {{&measures::drift, 0, 0, {1.0, 2.0, 3.0}, {0.1, 0.1, 0.5}},
                                          {&measures::drift, 2, 2, {1.0, 2.0, 3.0}, {0.1, 0.9, 0.1}},
                                          {&measures::memory, 1, 1, {1.0, 2.0}, {0.1, 0.4}},
                                          {&measures::spectrum, 1, 1, {1.0, 2.0}, {0.1, 0.11}}};
    GapReference reference = reference_of(curves);
    reference.window_sd.assign(curves.size(), {});
    const std::vector<Left> places = places_that_stand_out(curves, reference);
    ASSERT_EQ(places.size(), 2U);
    EXPECT_EQ(places[0].where.axes, (std::vector<std::size_t>{0, 2}));
    ASSERT_TRUE(places[0].where.time_s.has_value());
    EXPECT_EQ(places[0].where.time_s->from, 2.0);
    EXPECT_EQ(places[1].where.axes, std::vector<std::size_t>{1});
    EXPECT_GT(places[0].size, places[1].size);
}

}  // namespace
}  // namespace gyrolog
