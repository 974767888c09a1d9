#include "analysis/noise/curve_diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/noise/printed_curve.hpp"

namespace gyrolog {
namespace {

using Kind = CurveTerm::Kind;
using Verdict = CurveDiagnosis::Verdict;

using test::curve_of;
using test::nbk;

std::vector<ModelledTerm> model_of(const NoiseCoefficients& c, double sd_rel = 0.0) {
    std::vector<ModelledTerm> terms;
    for (const CurveTerm term :
         {CurveTerm{Kind::N, c.N_rad_per_sqrt_s, 0.0}, CurveTerm{Kind::B, c.B_rad_per_s, 0.0},
          CurveTerm{Kind::K, c.K_rad_per_s_sqrt_s, 0.0}}) {
        if (term.size > 0.0) { terms.push_back({term, sd_rel}); }
    }
    return terms;
}

constexpr test::Reading as_printed{.error = 0.02, .smooth_db = 0.1, .seed = 5};

TEST(CurveDiagnosis, OfTheModelsOwnCurveFindsNoGap) {
    int alarms = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const CurveDiagnosis diagnosis =
            diagnose_curve(curve_of(nbk(), {0.02, 0.1, seed}), model_of(nbk().coefficients));
        EXPECT_EQ(diagnosis.verdict == Verdict::none, diagnosis.causes.empty()) << seed;
        alarms += diagnosis.verdict != Verdict::none;
    }
    EXPECT_LE(alarms, 1);
}

TEST(CurveDiagnosis, SaysByWhatFactorACoefficientIsOff) {
    NoiseModel sensor = nbk();
    sensor.coefficients.N_rad_per_sqrt_s *= 1.4;
    sensor.coefficients.K_rad_per_s_sqrt_s *= 0.6;
    const CurveDiagnosis diagnosis =
        diagnose_curve(curve_of(sensor, as_printed), model_of(nbk().coefficients));
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    ASSERT_EQ(diagnosis.causes.size(), 2U);
    const auto of = [&](Kind kind) {
        return *std::ranges::find(diagnosis.causes, kind, [](const CurveCause& c) { return c.term.kind; });
    };
    EXPECT_NEAR(of(Kind::N).factor(), 1.4, 4.0 * 1.4 * of(Kind::N).size_sd_rel);
    EXPECT_NEAR(of(Kind::K).factor(), 0.6, 4.0 * 0.6 * of(Kind::K).size_sd_rel);
    EXPECT_LT(of(Kind::N).size_sd_rel, 0.05);
    EXPECT_LT(of(Kind::N).to_tau_s, 100.0);
    EXPECT_GT(of(Kind::K).from_tau_s, 100.0);
    EXPECT_GT(diagnosis.shrink, 0.95);
    EXPECT_GT(of(Kind::N).probability, 0.9);
    EXPECT_FALSE(of(Kind::N).is_of_model());
    EXPECT_TRUE(of(Kind::K).is_of_model());
    EXPECT_GT(of(Kind::N).share, 0.1);
    EXPECT_GT(of(Kind::K).share, 0.1);
    EXPECT_TRUE(diagnosis.left.empty());
    ASSERT_EQ(diagnosis.stretches.size(), 2U);
    EXPECT_NEAR(diagnosis.stretches[0].worst_db, 20.0 * std::log10(1.4), 0.7);
    EXPECT_LT(diagnosis.stretches[1].worst_db, 0.0);
}

TEST(CurveDiagnosis, NamesATermThatTheModelLacks) {
    NoiseModel sensor = nbk();
    sensor.coefficients.B_rad_per_s = 0.0;
    const std::vector<ModelledTerm> model = model_of(sensor.coefficients);

    NoiseModel markov = sensor;
    markov.gauss_markov = {{0.004, 20.0}};
    CurveDiagnosis diagnosis = diagnose_curve(curve_of(markov, as_printed), model);
    EXPECT_EQ(diagnosis.verdict, Verdict::known);
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    const CurveCause& process = diagnosis.causes[0];
    EXPECT_EQ(process.term.kind, Kind::gauss_markov);
    EXPECT_FALSE(process.in_model.has_value());
    EXPECT_NEAR(process.term.size, 0.004, 4.0 * 0.004 * process.size_sd_rel);
    EXPECT_NEAR(process.term.shape, 20.0, 4.0 * 20.0 * process.shape_sd_rel);
    EXPECT_LT(process.from_tau_s, 1.89 * 20.0);
    EXPECT_GT(process.to_tau_s, 1.89 * 20.0);

    NoiseModel flicker = sensor;
    flicker.coefficients.B_rad_per_s = 0.002;
    diagnosis = diagnose_curve(curve_of(flicker, as_printed), model);
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    EXPECT_EQ(diagnosis.causes[0].term.kind, Kind::B);

    NoiseModel quantised = sensor;
    quantised.coefficients.Q_rad = 8e-4;
    diagnosis = diagnose_curve(curve_of(quantised, as_printed), model);
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    EXPECT_EQ(diagnosis.causes[0].term.kind, Kind::Q);
    EXPECT_LT(diagnosis.causes[0].to_tau_s, 0.2);
}

// A term of which the curve has nothing is fitted to a size without meaning.
TEST(CurveDiagnosis, SaysThatACoefficientIsNotSeen) {
    NoiseModel sensor = nbk();
    sensor.coefficients.B_rad_per_s = 0.0;
    NoiseModel model = nbk();
    model.coefficients.B_rad_per_s *= 3.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const CurveDiagnosis diagnosis =
            diagnose_curve(curve_of(sensor, {0.02, 0.1, seed}), model_of(model.coefficients));
        ASSERT_EQ(diagnosis.causes.size(), 1U) << seed;
        EXPECT_EQ(diagnosis.causes[0].term.kind, Kind::B);
        EXPECT_EQ(diagnosis.causes[0].term.size, 0.0) << seed;
        EXPECT_EQ(diagnosis.causes[0].factor(), 0.0);
        EXPECT_GT(diagnosis.shrink, 0.9);
    }
    // Half of it is.
    sensor.coefficients.B_rad_per_s = 0.5 * model.coefficients.B_rad_per_s;
    const CurveDiagnosis less = diagnose_curve(curve_of(sensor, as_printed), model_of(model.coefficients));
    ASSERT_EQ(less.causes.size(), 1U);
    EXPECT_NEAR(less.causes[0].factor(), 0.5, 4.0 * 0.5 * less.causes[0].size_sd_rel);
}

TEST(CurveDiagnosis, TakesForNoGapWhatTheModelsUncertaintyCovers) {
    NoiseModel sensor = nbk();
    sensor.coefficients.N_rad_per_sqrt_s *= 1.1;
    const AllanCurve curve = curve_of(sensor, as_printed);
    EXPECT_EQ(diagnose_curve(curve, model_of(nbk().coefficients)).verdict, Verdict::known);
    const CurveDiagnosis loose = diagnose_curve(curve, model_of(nbk().coefficients, 0.2));
    EXPECT_EQ(loose.verdict, Verdict::none);
    EXPECT_TRUE(loose.causes.empty());
}

// Over two thirds of a decade a random walk's rise and a ramp's beginning are alike.
TEST(CurveDiagnosis, SaysWhatTheCurveCannotTellApart) {
    NoiseModel sensor;
    sensor.coefficients = {0.0, 0.01, 0.0, 5e-5, 0.0};
    AllanCurve curve = curve_of(sensor, as_printed);
    std::erase_if(curve.points, [](const AllanPoint& point) { return point.tau_s > 300.0; });
    const CurveDiagnosis diagnosis = diagnose_curve(curve, model_of({0.0, 0.01, 0.0, 0.0, 0.0}));
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    const CurveCause& cause = diagnosis.causes[0];
    ASSERT_FALSE(cause.rivals.empty());
    EXPECT_LT(cause.probability, 0.98);
    EXPECT_LT(cause.rivals.front().criterion_behind, curve_tie_margin);
    for (const CurveRival& rival : cause.rivals) { EXPECT_NE(rival.term.kind, cause.term.kind); }
}

TEST(CurveDiagnosis, OfAShapeThatNoTermHasSaysUnexplained) {
    AllanCurve curve = curve_of(nbk());
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        curve.points[i].deviation *= i % 6 < 3 ? 1.5 : 1.0 / 1.5;
    }
    const CurveDiagnosis diagnosis = diagnose_curve(curve, model_of(nbk().coefficients));
    EXPECT_GT(diagnosis.before.rms_db, 3.0);
    EXPECT_NE(diagnosis.verdict, Verdict::known);
}

// Three times K, which is a change, and a white noise in the model that is 1.6 times too much and may not
// change.
TEST(CurveDiagnosis, OfAGapThatAChangeClosesInPartSaysWhatIsLeft) {
    NoiseModel sensor = nbk();
    sensor.coefficients.K_rad_per_s_sqrt_s *= 3.0;
    NoiseModel noisy = nbk();
    noisy.coefficients.N_rad_per_sqrt_s *= 1.6;
    std::vector<ModelledTerm> model = model_of(noisy.coefficients);
    model[0].may_change = false;
    const CurveDiagnosis diagnosis = diagnose_curve(curve_of(sensor, as_printed), model);
    EXPECT_EQ(diagnosis.verdict, Verdict::partly);
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    EXPECT_EQ(diagnosis.causes[0].term.kind, Kind::K);
    EXPECT_NEAR(diagnosis.shrink, 0.64, 0.1);
    ASSERT_EQ(diagnosis.left.size(), 1U);
    EXPECT_NEAR(diagnosis.left[0].from_tau_s, 0.01, 1e-9);
    EXPECT_NEAR(diagnosis.left[0].floors, 20.0 * std::log10(1.6) / diagnosis.floor_db, 5.0);
}

// A share is what comes back: of one change all that it closes.
TEST(CurveDiagnosis, OfOneChangeTheShareIsWhatItCloses) {
    NoiseModel sensor = nbk();
    sensor.coefficients.N_rad_per_sqrt_s *= 1.4;
    const CurveDiagnosis diagnosis =
        diagnose_curve(curve_of(sensor, as_printed), model_of(nbk().coefficients));
    ASSERT_EQ(diagnosis.causes.size(), 1U);
    EXPECT_NEAR(diagnosis.causes[0].share, diagnosis.shrink, 1e-9);
}

TEST(CurveDiagnosis, ScalesWithTheCurve) {
    NoiseModel sensor = nbk();
    sensor.coefficients.N_rad_per_sqrt_s *= 1.4;
    AllanCurve curve = curve_of(sensor, as_printed);
    const CurveDiagnosis one = diagnose_curve(curve, model_of(nbk().coefficients));
    for (AllanPoint& point : curve.points) { point.deviation *= 1e-3; }
    const CurveDiagnosis small = diagnose_curve(curve, model_of({0.0, 1e-5, 2e-6, 1e-7, 0.0}));
    ASSERT_EQ(small.causes.size(), one.causes.size());
    EXPECT_NEAR(small.causes[0].factor(), one.causes[0].factor(), 1e-4);
    EXPECT_NEAR(small.before.rms_db, one.before.rms_db, 1e-9);
}

}  // namespace
}  // namespace gyrolog
