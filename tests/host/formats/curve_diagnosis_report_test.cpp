#include "host/formats/curve_diagnosis_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/effect.hpp"
#include "host/formats/curve_csv.hpp"
#include "host/formats/curve_effect.hpp"
#include "tests/host/formats/diagnosis_cases.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Kind = CurveTerm::Kind;

AllanCurve exact_curve(const NoiseModel& noise) {
    AllanCurve curve;
    for (int i = 0; i < 50; ++i) {
        AllanPoint point;
        point.tau_s = 0.01 * std::pow(1.3, i);
        point.deviation = std::sqrt(noise.allan_variance(point.tau_s));
        curve.points.push_back(point);
    }
    return curve;
}

SensorModel quiet_model() {
    SensorModel model = typical_mpu9250();
    model.effects.clear();
    model.lsb_rad_s = 0.0;
    model.sd_rel.clear();
    for (AxisModel& axis : model.axes) {
        axis.sd_rel.clear();
        axis.noise = {0.0, 0.01 * rad_per_deg, 0.002 * rad_per_deg, 1e-4 * rad_per_deg, 0.0};
    }
    return model;
}

// A sensor on x with 1.4 times the model's N and a Gauss-Markov process that it lacks, and 0.5 times K.
CurveDiagnosisReport report_of(const SensorModel& model) {
    NoiseModel sensor;
    sensor.coefficients = model.axes[0].noise;
    sensor.coefficients.N_rad_per_sqrt_s *= 1.4;
    sensor.coefficients.K_rad_per_s_sqrt_s *= 0.5;
    sensor.gauss_markov = {{0.01 * rad_per_deg, 20.0}};
    CurveDiagnosisReport report;
    report.curve_name = "paper.csv";
    report.model_name = "model.json";
    report.unit = {"dps", deg_per_rad};
    const AllanCurve curve = exact_curve(sensor);
    const std::vector<ModelledTerm> terms = curve_of_model(model, 0).terms;
    report.curves.push_back({"sensor_x", 0, curve, terms, diagnose_curve(curve, terms)});
    return report;
}

const CurveDiagnosisReport& quiet_report() {
    static const CurveDiagnosisReport report = report_of(quiet_model());
    return report;
}

const json* cause_of(const json& answer, const std::string& effect) {
    for (const json& cause : answer["causes"]) {
        if (cause["effect"] == effect) { return &cause; }
    }
    return nullptr;
}

TEST(CurveDiagnosisReport, SaysWhatIsNotSeenInWords) {
    SensorModel model = quiet_model();
    CurveDiagnosisReport report;
    report.unit = {"dps", deg_per_rad};
    NoiseModel sensor;
    sensor.coefficients = model.axes[0].noise;
    sensor.coefficients.B_rad_per_s = 0.0;
    model.axes[0].noise.B_rad_per_s *= 3.0;
    const AllanCurve curve = exact_curve(sensor);
    const std::vector<ModelledTerm> terms = curve_of_model(model, 0).terms;
    report.curves.push_back({"sensor_x", 0, curve, terms, diagnose_curve(curve, terms)});
    EXPECT_THAT(test::joined(curve_diagnosis_text(report)), HasSubstr("No B seen, where the model has"));
    ASSERT_EQ(report.curves[0].diagnosis.causes.size(), 1U);
    correct(model, 0, report.curves[0].diagnosis.causes[0]);
    EXPECT_EQ(model.axes[0].noise.B_rad_per_s, 0.0);
}

TEST(CurveDiagnosisReport, NamesAnAxisOnceThatHasTwoOfAnEffect) {
    CurveDiagnosisReport report = report_of(quiet_model());
    std::vector<CurveCause>& causes = report.curves[0].diagnosis.causes;
    const auto process = std::ranges::find(causes, Kind::gauss_markov,
                                           [](const CurveCause& cause) { return cause.term.kind; });
    ASSERT_NE(process, causes.end());
    const double gain_nats = 0.5 * process->criterion_gain;
    causes.push_back(*process);
    const Diagnosis diagnosis = as_diagnosis(report);
    const auto cause = std::ranges::find(diagnosis.causes, "gauss_markov",
                                         [](const Cause& one) { return one.finding.effect; });
    ASSERT_NE(cause, diagnosis.causes.end());
    EXPECT_EQ(cause->finding.entries.size(), 2U);
    EXPECT_EQ(cause->finding.where.axes, std::vector<std::size_t>{0});
    EXPECT_NEAR(cause->finding.axis_gain_nats[0], 2.0 * gain_nats, 1e-9);
}

TEST(CurveDiagnosisReport, NamesFactorAndMissingTermUnderTheEffectsNames) {
    const json answer = json::parse(curve_diagnosis_json(quiet_report()));
    EXPECT_EQ(answer["schema"], "gyrolog-diagnosis/2");
    EXPECT_EQ(answer["verdict"], "known");
    const json* white = cause_of(answer, "arw_scale");
    ASSERT_NE(white, nullptr) << answer.dump(1);
    EXPECT_NEAR((*white)["params"]["factor"].get<double>(), 1.4, 0.02);
    EXPECT_EQ((*white)["axes"], json({"x"}));
    EXPECT_EQ((*white)["where"]["tau_s"].size(), 2U);
    const json* process = cause_of(answer, "gauss_markov");
    ASSERT_NE(process, nullptr);
    EXPECT_NEAR((*process)["params"]["sigma_dps"].get<double>(), 0.01, 0.0005);
    EXPECT_NEAR((*process)["params"]["tau_s"].get<double>(), 20.0, 2.0);
    EXPECT_GT((*process)["sd"]["tau_s"].get<double>(), 0.0);
    const json* walk = cause_of(answer, "rrw_excess");
    ASSERT_NE(walk, nullptr);
    EXPECT_NEAR((*walk)["params"]["factor"].get<double>(), 0.5, 0.05);
    const json& curve = answer["curves"]["sensor_x"];
    EXPECT_NEAR(curve["coefficients"]["N"]["factor"].get<double>(), 1.4, 0.02);
    EXPECT_EQ(curve["coefficients"]["N"]["unit"], "dps/sqrt(Hz)");
    EXPECT_GT(curve["before"]["rms_dB"].get<double>(), curve["after"]["rms_dB"].get<double>());
    EXPECT_GT(answer["shrink"].get<double>(), 0.95);
    EXPECT_EQ((*white)["sense"], "recording_has");
    EXPECT_EQ((*walk)["sense"], "model_has");
    // Most of the gap comes back without either, and none of it is left.
    double shares = 0.0;
    for (const json& cause : answer["causes"]) {
        EXPECT_GT(cause["share"].get<double>(), 0.02) << cause["effect"];
        shares += cause["share"].get<double>();
        EXPECT_FALSE(cause.contains("share_lo"));
    }
    EXPECT_GT(shares, 0.7);
    EXPECT_TRUE(std::ranges::is_sorted(answer["causes"], std::ranges::greater(),
                                       [](const json& cause) { return cause["share"].get<double>(); }));
    EXPECT_EQ(answer["unnamed"], json::array());
    EXPECT_EQ(answer["left"], json::array());
    EXPECT_EQ(answer["gap_named"], answer["gap_after"]);
    EXPECT_EQ(answer["shrink_modelled"], answer["shrink"]);
    EXPECT_EQ(answer["not_held_out"].size(), answer["causes"].size());
    for (const char* of_recordings : {"p_none", "seed", "simulations", "held_out", "shrink_lo"}) {
        EXPECT_FALSE(answer.contains(of_recordings)) << of_recordings;
    }
}

TEST(CurveDiagnosisReport, SaysWhereTheModelErrsAndWhatDoesIt) {
    const std::string text = test::joined(curve_diagnosis_text(quiet_report()));
    EXPECT_THAT(text, StartsWith("known: "));
    EXPECT_THAT(text, HasSubstr("share of gap"));
    EXPECT_THAT(text, HasSubstr("the model is too quiet by up to"));
    EXPECT_THAT(text, HasSubstr("The sensor's N is 1.4"));
    EXPECT_THAT(text, HasSubstr("The model lacks Gauss-Markov 0.0"));
    EXPECT_THAT(text, HasSubstr("% of the gap, probability"));
    EXPECT_THAT(text, HasSubstr("after:"));
    EXPECT_THAT(text, Not(HasSubstr("left: ")));
}

// Three times K, which is a change, and a white noise in the model that is 1.6 times too much and may not
// change.
TEST(CurveDiagnosisReport, SaysWhatIsLeftAndWhere) {
    NoiseModel sensor;
    sensor.coefficients = quiet_model().axes[0].noise;
    sensor.coefficients.K_rad_per_s_sqrt_s *= 3.0;
    const AllanCurve curve = exact_curve(sensor);
    std::vector<ModelledTerm> terms = curve_of_model(quiet_model(), 0).terms;
    ASSERT_EQ(terms[0].term.kind, Kind::N);
    terms[0].term.size *= 1.6;
    terms[0].may_change = false;
    CurveDiagnosisReport report;
    report.unit = {"dps", deg_per_rad};
    report.curves.push_back({"sensor_x", 0, curve, terms, diagnose_curve(curve, terms)});
    const json answer = json::parse(curve_diagnosis_json(report));
    EXPECT_EQ(answer["verdict"], "partly") << answer.dump(1);
    EXPECT_GT(answer["shrink"].get<double>(), 0.1);
    EXPECT_LT(answer["shrink"].get<double>(), 0.9);
    ASSERT_FALSE(answer["left"].empty());
    const json& left = answer["left"][0];
    EXPECT_EQ(left["where"]["axes"], json({"x"}));
    EXPECT_EQ(left["where"]["tau_s"][0].get<double>(), 0.01);
    EXPECT_GT(left["where"]["tau_s"][1].get<double>(), 1.0);
    EXPECT_GT(left["size"].get<double>(), curve_floors_closed);
    const std::string text = curve_diagnosis_text(report);
    EXPECT_THAT(text, StartsWith("partly: rrw_missing on x (0.000277 deg/s*sqrt(Hz)) explains "));
    EXPECT_THAT(text, HasSubstr("    left: "));
}

TEST(CurveDiagnosisReport, MergesOneEffectOnSeveralAxes) {
    CurveDiagnosisReport report = quiet_report();
    report.curves.push_back(report.curves.front());
    report.curves.back().name = "sensor_z";
    report.curves.back().axis = 2;
    const Diagnosis diagnosis = as_diagnosis(report);
    EXPECT_EQ(diagnosis.causes.size(), report.curves[0].diagnosis.causes.size());
    EXPECT_EQ(diagnosis.causes[0].finding.where.axes, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(diagnosis.domains.size(), 2U);
    const json answer = json::parse(curve_diagnosis_json(report));
    EXPECT_TRUE(answer["causes"][0]["params_by_axis"].contains("z"));
}

TEST(CurveEffect, OfAMissingTermCanBeSimulated) {
    for (const Kind kind : {Kind::B, Kind::K, Kind::Q, Kind::R, Kind::gauss_markov, Kind::sinusoid}) {
        CurveCause cause;
        cause.term = {kind, 1e-4, 3.0};
        const CurveEffect effect = effect_of(cause);
        EXPECT_EQ(effect.effect, effect_name(kind));
        EXPECT_FALSE(effect_refusal({effect.effect, {"x"}, effect.params, ""})) << effect.effect;
    }
}

TEST(CurveEffect, AddsWhatTheModelLacksOfACoefficient) {
    CurveCause cause;
    cause.term = {Kind::B, 5e-5, 0.0};
    cause.in_model = CurveTerm{Kind::B, 3e-5, 0.0};
    cause.size_sd_rel = 0.1;
    EXPECT_NEAR(effect_of(cause).params.at("B_dps"), 4e-5 * deg_per_rad, 1e-12);
    EXPECT_NEAR(effect_of(cause).sd.at("B_dps"), 5e-6 * 5.0 / 4.0 * deg_per_rad, 1e-12);
    cause.term.size = 1.5e-5;
    EXPECT_EQ(effect_of(cause).effect, "flicker_excess");
    EXPECT_NEAR(effect_of(cause).params.at("factor"), 0.5, 1e-12);
}

TEST(CurveEffect, TheCorrectedModelHasTheCurve) {
    SensorModel model = quiet_model();
    const CurveDiagnosisReport& report = quiet_report();
    for (const CurveCause& cause : report.curves[0].diagnosis.causes) { correct(model, 0, cause); }
    const CurveDiagnosis again = diagnose_curve(report.curves[0].curve, curve_of_model(model, 0).terms);
    EXPECT_EQ(again.verdict, CurveDiagnosis::Verdict::none);
    EXPECT_TRUE(again.causes.empty());
    EXPECT_EQ(model.axes[1].noise.N_rad_per_sqrt_s, quiet_model().axes[1].noise.N_rad_per_sqrt_s);
}

TEST(CurveEffect, SaysWhichEffectsOfTheModelACurveDoesNotShow) {
    SensorModel model = quiet_model();
    model.lsb_rad_s = 0.01 * rad_per_deg;
    model.effects = {{"gauss_markov", {"x"}, {{"sigma_dps", 0.01}, {"tau_s", 20.0}}, ""},
                     {"arw_scale", {}, {{"factor", 2.0}}, ""},
                     {"spikes", {"x"}, {{"per_hour", 3.0}}, ""},
                     {"spikes", {"y"}, {{"per_hour", 3.0}}, ""}};
    const ModelledCurve curve = curve_of_model(model, 0);
    EXPECT_EQ(curve.not_in_curve, std::vector<std::string>{"spikes"});
    double variance = 0.0;
    for (const ModelledTerm& modelled : curve.terms) { variance += modelled.term.allan_variance(1.0); }
    NoiseModel noise{model.axes[0].noise, {{0.01 * rad_per_deg, 20.0}}, {}, {model.lsb_rad_s, model.rate_hz}};
    noise.coefficients.N_rad_per_sqrt_s *= 2.0;
    EXPECT_NEAR(variance, noise.allan_variance(1.0), 1e-9 * variance);
}

// The folder's ORIGIN.md: 2.3 dB RMS, 4.7 dB too quiet at 13 ms, too loud at 1e4 s.
TEST(CurveDiagnosisReport, OfThePublishedSimulationFindsItsErrors) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const auto curves = read_curve_csv(shared_data("published_mpu9250_curve/sensor_vs_simulation_x_dps.csv"));
    ASSERT_TRUE(curves.ok());
    std::vector<ModelledTerm> terms;
    for (const CurveTerm& term : fit_curve_model(curves->curves[1].curve).terms) {
        terms.push_back({term, 0.0, true});
    }
    const AllanCurve& sensor = curves->curves[0].curve;
    const CurveDiagnosis diagnosis = diagnose_curve(sensor, terms);
    EXPECT_NEAR(diagnosis.before.rms_db, 2.3, 0.1);
    EXPECT_NEAR(diagnosis.before.worst_db, 4.7, 0.3);
    EXPECT_NEAR(diagnosis.before.worst_tau_s, 0.013, 0.001);
    EXPECT_EQ(diagnosis.verdict, CurveDiagnosis::Verdict::known);
    ASSERT_GE(diagnosis.stretches.size(), 2U);
    EXPECT_GT(diagnosis.stretches.front().worst_db, 4.0);
    EXPECT_LT(diagnosis.stretches.back().worst_db, -2.5);
    EXPECT_GT(diagnosis.shrink, 0.9);
    const auto white =
        std::ranges::find(diagnosis.causes, Kind::N, [](const CurveCause& c) { return c.term.kind; });
    ASSERT_NE(white, diagnosis.causes.end());
    EXPECT_NEAR(white->factor(), 1.40, 0.06);
    const auto walk =
        std::ranges::find(diagnosis.causes, Kind::K, [](const CurveCause& c) { return c.term.kind; });
    ASSERT_NE(walk, diagnosis.causes.end());
    EXPECT_NEAR(walk->factor(), 0.73, 0.06);
    EXPECT_TRUE(std::ranges::any_of(diagnosis.causes, [](const CurveCause& c) { return !c.in_model; }));
}

}  // namespace
}  // namespace gyrolog
