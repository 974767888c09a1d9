#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/comparison_json.hpp"
#include "host/formats/comparison_text.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

ComparedCurve curve_with_gap(double at, double dB, bool stands_out) {
    ComparedCurve curve;
    curve.at = {0.013, 0.1, 1.0};
    curve.recording = {2.0 * rad_per_deg, 1.0 * rad_per_deg, 1.0 * rad_per_deg};
    curve.other = {1.0 * rad_per_deg, 1.0 * rad_per_deg, 1.0 * rad_per_deg};
    curve.lo = {0.9 * rad_per_deg, 0.8 * rad_per_deg, 0.7 * rad_per_deg};
    curve.hi = {1.1 * rad_per_deg, 1.2 * rad_per_deg, 1.3 * rad_per_deg};
    curve.outside = {{0.013, 0.1, at, dB, 2}};
    curve.points_by_chance = 0.15;
    curve.simulations_outside_as_often = 1;
    curve.gap = {at, dB, 7.0, stands_out};
    return curve;
}

Comparison against_a_model() {
    Comparison comparison;
    comparison.recording_name = "night.csv";
    comparison.other_name = "model.json";
    comparison.rate_hz = 100.0;
    comparison.duration_s = 3600.0;
    comparison.samples = 360'000;
    comparison.simulations = 40;
    comparison.band_probability = 1.0 - 2.0 / 41.0;
    comparison.seed = 1;
    AxisComparison axis;
    axis.axis = "x";
    axis.allan = curve_with_gap(0.013, 4.7, true);
    axis.spectrum = curve_with_gap(0.1, -1.2, false);
    axis.standard_deviation = {0.05 * rad_per_deg, 0.04 * rad_per_deg, 0.039 * rad_per_deg,
                               0.041 * rad_per_deg};
    axis.skewness = {0.001, 0.0, -0.01, 0.01};
    axis.excess_kurtosis = {0.01, 0.0, -0.02, 0.02};
    comparison.axes = {axis};
    comparison.notes = {"a note"};
    comparison.warnings = {"a warning"};
    return comparison;
}

// Its text up to the table.
std::string sentences(const Comparison& comparison) {
    const std::string text = comparison_text(comparison, Wording::brief);
    return text.substr(0, text.find("\n\n") + 1);
}

TEST(ComparisonText, BeginsWithAPlainSentence) {
    Comparison comparison = against_a_model();
    EXPECT_EQ(sentences(comparison),
              "x: the simulation is too quiet by 4.7 dB at 13 ms (Allan deviation 2, simulated\n   1 dps)\n");
    comparison.axes[0].allan.gap.dB = -4.7;
    EXPECT_THAT(sentences(comparison), StartsWith("x: the simulation is too noisy by 4.7 dB at 13 ms ("));
    comparison.axes[0].spectrum.gap.stands_out = true;
    comparison.axes[0].spectrum.gap.distance = 9.0;
    EXPECT_EQ(
        sentences(comparison),
        "x: the simulation is too noisy by 1.2 dB at 0.1 Hz (noise density 1, simulated 1\n   dps/√Hz)\n");
    comparison.axes[0].allan.gap.stands_out = comparison.axes[0].spectrum.gap.stands_out = false;
    EXPECT_THAT(sentences(comparison), HasSubstr("no more than simulations do"));
}

// What one acts on comes first; the places only where they are wanted.
TEST(ComparisonText, SaysItInTheOrderInWhichOneAsks) {
    const std::string text = comparison_text(against_a_model());
    std::size_t before = 0;
    for (const char* part : {"x: the simulation", "  std. deviation   dps             0.05\n",
                             "     simulated                     0.039 to 0.041",
                             "what to do next\n  - `gyrolog diagnose night.csv --model model.json` says",
                             "compared: night.csv, 60 min, against", "model: a note", "band: ", "by chance",
                             "warning: a warning"}) {
        const std::size_t at = text.find(part, before);
        ASSERT_NE(at, std::string::npos) << part << '\n' << text;
        before = at;
    }
    const std::string brief = comparison_text(against_a_model(), Wording::brief);
    EXPECT_THAT(brief, Not(HasSubstr("by chance")));
    EXPECT_THAT(brief, HasSubstr("warning: a warning"));
    Comparison alike = against_a_model();
    alike.axes[0].allan.gap.stands_out = false;
    EXPECT_THAT(comparison_text(alike), HasSubstr("  - use the model: it makes such recordings."));
}

TEST(ComparisonText, SaysTheDistributionWhereThatStandsOut) {
    Comparison comparison = against_a_model();
    AxisComparison& axis = comparison.axes[0];
    axis.excess_kurtosis = {671.3, 0.0, -0.016, 0.019, 400.0, true};
    EXPECT_EQ(sentences(comparison),
              "x: the simulation is too quiet by 4.7 dB at 13 ms (Allan deviation 2, simulated\n"
              "   1 dps); the samples' excess kurtosis is 671, of simulations -0.016 to 0.019\n");
    axis.allan.gap.stands_out = false;
    EXPECT_EQ(sentences(comparison),
              "x: the samples' excess kurtosis is 671, of simulations -0.016 to 0.019\n");
    EXPECT_THAT(comparison_text(comparison), HasSubstr("stands out"));
    EXPECT_EQ(json::parse(comparison_json(comparison))["axes"]["x"]["excess_kurtosis"]["distance"], 400.0);
    axis.excess_kurtosis.stands_out = false;
    axis.standard_deviation.stands_out = true;
    EXPECT_EQ(sentences(comparison),
              "x: the samples' standard deviation is 0.05 dps, of simulations 0.039 to 0.041\n   dps\n");
    axis.allan.gap.stands_out = true;
    EXPECT_THAT(sentences(comparison), Not(HasSubstr("standard deviation is")));
}

TEST(ComparisonText, SaysWhatTheBandIsAndWhatChanceWouldGive) {
    const std::string text = comparison_text(against_a_model());
    EXPECT_THAT(text, HasSubstr("night.csv, 60 min, against 40 simulations of model.json (seed 1)"));
    EXPECT_THAT(text, HasSubstr("from the smallest to the largest"));
    EXPECT_THAT(text, HasSubstr("probability 95.12 %"));
    EXPECT_THAT(text, HasSubstr("Allan deviation    2 of 3          0.1        1 of 40\n"));
    EXPECT_THAT(text, HasSubstr("13 ms to 100 ms: too quiet by 4.7 dB at worst, at 13 ms (2 points)"));
    EXPECT_THAT(text, Not(HasSubstr("13 mHz to 0.1 Hz"))) << "nothing differs there";
    EXPECT_THAT(text, HasSubstr("0.039 to 0.041  outside"));
    EXPECT_THAT(text, HasSubstr("warning: a warning"));
    EXPECT_THAT(text, HasSubstr("model: a note"));
    Comparison many = against_a_model();
    many.simulations = 100;
    many.band_probability = band_probability(100);
    EXPECT_THAT(comparison_text(many), HasSubstr("from the 2. smallest to the 2. largest"));
}

TEST(ComparisonText, ListsTheLargestRangesOnly) {
    Comparison comparison = against_a_model();
    ComparedCurve& curve = comparison.axes[0].allan;
    curve.outside.clear();
    for (int i = 1; i <= 9; ++i) { curve.outside.push_back({i * 1.0, i * 1.0, i * 1.0, 0.1 * i, 1}); }
    const std::string text = comparison_text(comparison);
    EXPECT_THAT(text, HasSubstr("and 3 smaller ones"));
    EXPECT_THAT(text, HasSubstr("at 9 s: too quiet by 0.9 dB"));
    EXPECT_THAT(text, Not(HasSubstr("at 3 s")));
}

TEST(ComparisonText, ListsNoPlacesWhereChanceDoesAsMuch) {
    Comparison comparison = against_a_model();
    for (const std::size_t as_often : {0U, 2U}) {
        comparison.axes[0].spectrum.simulations_outside_as_often = as_often;
        EXPECT_THAT(comparison_text(comparison), Not(HasSubstr("13 mHz to 0.1 Hz"))) << as_often;
    }
    comparison.axes[0].spectrum.gap.stands_out = true;
    EXPECT_THAT(comparison_text(comparison), HasSubstr("13 mHz to 0.1 Hz: too noisy by 1.2 dB"));
    comparison.axes[0].spectrum.gap.stands_out = false;
    const std::string text = comparison_text(comparison);
    EXPECT_THAT(text, ContainsRegex("spectrum .* 2 of 40\n  Allan deviation\n    13 ms"));
    EXPECT_THAT(text, HasSubstr("13 ms to 100 ms")) << "this one stands out";
}

TEST(ComparisonText, OfTwoRecordingsSpeaksOfTheFirst) {
    Comparison comparison = against_a_model();
    comparison.simulations = 0;
    comparison.other_name = "day.csv";
    comparison.other_duration_s = 7200.0;
    for (ComparedNumber* number : {&comparison.axes[0].standard_deviation, &comparison.axes[0].skewness,
                                   &comparison.axes[0].excess_kurtosis}) {
        number->lo.reset();
        number->hi.reset();
    }
    comparison.less_reference = true;
    const std::string text = comparison_text(comparison);
    EXPECT_THAT(sentences(comparison),
                StartsWith("x: the first recording is noisier by 4.7 dB at 13 ms (Allan "));
    EXPECT_THAT(text, HasSubstr("`gyrolog analyze` of each says which noise term differs."));
    EXPECT_THAT(text, HasSubstr("night.csv, 60 min, against day.csv, 2 h"));
    EXPECT_THAT(text, HasSubstr("intervals of the two do not meet"));
    EXPECT_THAT(text, HasSubstr("less the reference"));
}

TEST(ComparisonJson, HasTheCurvesInDegreesWithTheirBand) {
    const json answer = json::parse(comparison_json(against_a_model()));
    EXPECT_EQ(answer["schema"], "gyrolog-compare/1");
    EXPECT_EQ(answer["with"], "simulations");
    EXPECT_EQ(answer["simulations"], 40);
    const json& allan = answer["axes"]["x"]["allan"];
    EXPECT_EQ(allan["tau_s"], (std::vector<double>{0.013, 0.1, 1.0}));
    EXPECT_DOUBLE_EQ(allan["recording"][0], 2.0);
    EXPECT_DOUBLE_EQ(allan["lo"][2], 0.7);
    EXPECT_DOUBLE_EQ(allan["hi"][1], 1.2);
    EXPECT_NEAR(allan["ratio_dB"][0].get<double>(), 6.0206, 1e-4);
    EXPECT_EQ(allan["outside"][0]["points"], 2);
    EXPECT_EQ(allan["largest_gap"]["stands_out"], true);
    EXPECT_FALSE(allan.contains("recording_lo"));
    EXPECT_TRUE(answer["axes"]["x"]["spectrum"].contains("f_hz"));
    EXPECT_DOUBLE_EQ(answer["axes"]["x"]["standard_deviation"]["hi"], 0.041);
    EXPECT_EQ(answer["axes"]["x"]["sentence"],
              "x: the simulation is too quiet by 4.7 dB at 13 ms (Allan deviation 2, simulated 1 dps)");
    EXPECT_EQ(answer["warnings"][0], "a warning");
}

// A simulation is as long as its recording; another recording may be shorter, and the figure says so.
TEST(ComparisonFacts, HaveTheLengthsOfTwoRecordings) {
    Comparison comparison = against_a_model();
    EXPECT_THAT(comparison_facts(comparison), ElementsAre("100 Hz", "60 min", "360,000 samples"));
    comparison.simulations = 0;
    comparison.other_duration_s = 1800.0;
    EXPECT_THAT(comparison_facts(comparison),
                ElementsAre("100 Hz", "60 min (the other 30 min)", "360,000 samples"));
    comparison.other_duration_s = 3600.4;
    EXPECT_THAT(comparison_facts(comparison), ElementsAre("100 Hz", "60 min", "360,000 samples"));
}

}  // namespace
}  // namespace gyrolog
