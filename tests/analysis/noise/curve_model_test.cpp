#include "analysis/noise/curve_model.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/noise/curve_gap.hpp"
#include "tests/analysis/noise/printed_curve.hpp"

namespace gyrolog {
namespace {

using Kind = CurveTerm::Kind;

using test::all_five;
using test::curve_of;
using test::kinds_of;
using test::nbk;
using test::print_first_s;
using test::print_points;
using test::with_gauss_markov;
using test::with_sinusoid;

const CurveTerm& only(const CurveModelFit& fit, Kind kind) {
    const auto found = std::ranges::find(fit.terms, kind, &CurveTerm::kind);
    EXPECT_NE(found, fit.terms.end()) << name_of(kind);
    return *found;
}

TEST(CurveModel, GivesBackTheTermsOfAnExactCurve) {
    const CurveModelFit five = fit_curve_model(curve_of(all_five()));
    EXPECT_EQ(kinds_of(five.terms), "Q N B K R");
    EXPECT_NEAR(only(five, Kind::Q).size, 5e-4, 5e-4 * 1e-4);
    EXPECT_NEAR(only(five, Kind::N).size, 0.01, 0.01 * 1e-4);
    EXPECT_NEAR(only(five, Kind::B).size, 0.002, 0.002 * 1e-4);
    EXPECT_NEAR(only(five, Kind::K).size, 1e-4, 1e-4 * 1e-4);
    EXPECT_NEAR(only(five, Kind::R).size, 2e-6, 2e-6 * 1e-4);
    EXPECT_LT(five.residual.rms_db, 1e-4);

    const CurveModelFit markov = fit_curve_model(curve_of(with_gauss_markov()));
    EXPECT_EQ(kinds_of(markov.terms), "N K Gauss-Markov");
    EXPECT_NEAR(only(markov, Kind::gauss_markov).size, 0.004, 0.004 * 1e-3);
    EXPECT_NEAR(only(markov, Kind::gauss_markov).shape, 20.0, 20.0 * 1e-3);

    const CurveModelFit line = fit_curve_model(curve_of(with_sinusoid()));
    EXPECT_EQ(kinds_of(line.terms), "N B K sinusoid");
    EXPECT_NEAR(only(line, Kind::sinusoid).size, 0.006, 0.006 * 1e-3);
    EXPECT_NEAR(only(line, Kind::sinusoid).shape, 0.05, 0.05 * 1e-3);
}

TEST(CurveModel, ScalesWithTheCurve) {
    AllanCurve curve = curve_of(with_gauss_markov());
    for (AllanPoint& point : curve.points) {
        point.tau_s *= 100.0;
        point.deviation *= 3.0;
    }
    const CurveModelFit fit = fit_curve_model(curve);
    EXPECT_EQ(kinds_of(fit.terms), "N K Gauss-Markov");
    EXPECT_NEAR(only(fit, Kind::N).size, 0.01 * 3.0 * 10.0, 1e-4);
    EXPECT_NEAR(only(fit, Kind::K).size, 1e-4 * 3.0 / 10.0, 1e-8);
    EXPECT_NEAR(only(fit, Kind::gauss_markov).shape, 2000.0, 2.0);
}

TEST(CurveModel, TheLadderTellsEveryStepAndItsResidual) {
    const CurveModelFit fit = fit_curve_model(curve_of(with_gauss_markov(), {.error = 0.02}));
    ASSERT_GE(fit.steps.size(), 2U);
    EXPECT_EQ(fit.steps.front().change, CurveFitStep::Change::start);
    EXPECT_EQ(kinds_of(fit.steps.front().terms), "N B K");
    const auto added = std::ranges::find(fit.steps, CurveFitStep::Change::added, &CurveFitStep::change);
    ASSERT_NE(added, fit.steps.end());
    EXPECT_EQ(added->term, Kind::gauss_markov);
    EXPECT_LT(added->residual.rms_db, fit.steps.front().residual.rms_db / 2.0);
    EXPECT_DOUBLE_EQ(fit.steps.back().residual.rms_db, fit.residual.rms_db);
    for (const RejectedTerm& rejected : fit.rejected) { EXPECT_LE(rejected.criterion_gain, 6.0); }
}

TEST(CurveModel, ThreePointsAreTooFew) {
    AllanCurve curve = curve_of(nbk());
    curve.points.resize(curve_fit_points_min - 1);
    EXPECT_TRUE(fit_curve_model(curve).terms.empty());
    curve = curve_of(nbk());
    curve.points.resize(curve_fit_points_min);
    EXPECT_FALSE(fit_curve_model(curve).terms.empty());
}

TEST(CurveGap, NamesWhatTheSimulationLacksAndWhere) {
    NoiseModel sensor;
    sensor.coefficients = {8e-4, 0.018, 0.0, 2e-4, 0.0};
    NoiseModel simulation;
    simulation.coefficients = {0.0, 0.018, 0.0, 4e-4, 0.0};
    const AllanCurve measured = curve_of(sensor);
    const AllanCurve simulated = curve_of(simulation);
    const auto gap =
        compare_curves(measured, fit_curve_model(measured), simulated, fit_curve_model(simulated));
    ASSERT_TRUE(gap.has_value());
    EXPECT_EQ(gap->points, static_cast<std::size_t>(print_points));
    ASSERT_EQ(gap->terms.size(), 3U);
    EXPECT_EQ(gap->terms[0].kind, Kind::Q);
    EXPECT_EQ(gap->terms[0].verdict, CurveGapTerm::Verdict::lacking);
    EXPECT_EQ(gap->terms[1].verdict, CurveGapTerm::Verdict::agrees);
    EXPECT_EQ(gap->terms[2].verdict, CurveGapTerm::Verdict::too_strong);
    ASSERT_EQ(gap->stretches.size(), 2U);
    EXPECT_EQ(gap->stretches[0].term, Kind::Q);
    EXPECT_GT(gap->stretches[0].worst_db, 0.0);
    EXPECT_DOUBLE_EQ(gap->stretches[0].from_tau_s, print_first_s);
    EXPECT_EQ(gap->stretches[1].term, Kind::K);
    EXPECT_NEAR(gap->stretches[1].worst_db, 20.0 * std::log10(0.5), 0.05);
}

TEST(CurveGap, OfACurveToItselfIsNothing) {
    const AllanCurve curve = curve_of(nbk(), {.error = 0.02});
    const CurveModelFit fit = fit_curve_model(curve);
    const auto gap = compare_curves(curve, fit, curve, fit);
    ASSERT_TRUE(gap.has_value());
    EXPECT_EQ(gap->residual.rms_db, 0.0);
    EXPECT_TRUE(gap->stretches.empty());
    for (const CurveGapTerm& term : gap->terms) { EXPECT_EQ(term.verdict, CurveGapTerm::Verdict::agrees); }
}

TEST(CurveGap, NeedsAnAveragingTimeThatBothHave) {
    const AllanCurve curve = curve_of(nbk());
    AllanCurve later = curve;
    for (AllanPoint& point : later.points) { point.tau_s *= 1e9; }
    const CurveModelFit fit = fit_curve_model(curve);
    EXPECT_FALSE(compare_curves(curve, fit, later, fit).has_value());
}

}  // namespace
}  // namespace gyrolog
