#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/formats/diagnosis_json.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/formats/place_text.hpp"
#include "host/formats/text_width.hpp"
#include "tests/host/formats/diagnosis_cases.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using test::allan_domain;
using test::different_axes;
using test::joined;
using test::known;
using test::none;
using test::partly;
using test::with_line_of_model;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(DiagnosisText, SaysTheVerdictInItsFirstLine) {
    EXPECT_THAT(diagnosis_text(known()),
                StartsWith("known: temp_lag on x (0.021 deg/s per degC, 6.83 min) explains the gap\n"));
    EXPECT_THAT(diagnosis_text(none()), StartsWith("no gap: the recording could have come from the model\n"));
    Diagnosis two = known();
    two.causes.push_back(two.causes[0]);
    two.causes[1].finding.effect = "tone";
    two.causes[1].finding.where.axes = {1, 2};
    EXPECT_THAT(diagnosis_text(two),
                StartsWith("known: temp_lag on x and tone on y and z explain the gap\n"));
    two.causes[1].finding.where.axes = {0};
    EXPECT_EQ(verdict_sentence(two), "known: temp_lag and tone on x explain the gap");
    EXPECT_EQ(short_verdict_sentence(two), "known: 2 causes explain the gap");
    two.verdict = Verdict::partly;
    two.shrink.value = 0.624;
    EXPECT_EQ(verdict_sentence(two), "partly: temp_lag and tone on x explain 62 % of the gap");
    two.verdict = Verdict::unexplained;
    EXPECT_EQ(verdict_sentence(two),
              "unexplained: there is a gap, and temp_lag and tone on x explain too little of it");
    two.causes.clear();
    EXPECT_EQ(verdict_sentence(two), "unexplained: there is a gap, and no known effect makes it");
}

TEST(DiagnosisText, OfManyCausesNamesTheFirstInItsFirstLine) {
    Diagnosis many = known();
    many.causes.assign(6, many.causes[0]);
    many.causes[1].finding.effect = "tone";
    many.causes[1].finding.where.axes = {1, 2};
    EXPECT_EQ(verdict_sentence(many), "known: 5 × temp_lag on x and tone on y and z explain the gap");
    many.causes.resize(3);
    EXPECT_EQ(verdict_sentence(many), "known: 2 × temp_lag on x and tone on y and z explain the gap");
    many.causes[2].finding.effect = "rtn";
    EXPECT_EQ(verdict_sentence(many), "known: temp_lag on x, tone on y and z and rtn on x explain the gap");
    many.causes.resize(6, many.causes[2]);
    many.causes[5].finding.effect = "spikes";
    EXPECT_EQ(verdict_sentence(many), "known: temp_lag on x, tone on y and z and 2 more explain the gap");
}

// Also where nothing is open.
TEST(DiagnosisText, SaysWhatToDoNextWithEveryVerdict) {
    Diagnosis diagnosis = known();
    diagnosis.next_recordings.clear();
    EXPECT_THAT(joined(diagnosis_text(diagnosis)),
                HasSubstr("what to do next - `--model-out FILE` writes the model with the cause in it, which "
                          "`gyrolog simulate` takes."));
    EXPECT_THAT(joined(diagnosis_text(partly())), HasSubstr("`--unnamed` adds what has no name."));
    EXPECT_THAT(joined(diagnosis_text(none())), HasSubstr("use the model: it makes such recordings."));
    Diagnosis unexplained = partly();
    unexplained.verdict = Verdict::unexplained;
    unexplained.causes.clear();
    EXPECT_THAT(joined(diagnosis_text(unexplained)), HasSubstr("`--model-out FILE --unnamed` writes"));
}

// A size that `analyze` has only a limit for is no contradiction.
TEST(DiagnosisText, JoinsItsSlowNoiseWithTheLimitsOfAnAnalysis) {
    Diagnosis diagnosis = known();
    EXPECT_THAT(joined(diagnosis_text(diagnosis)), Not(HasSubstr("upper limit")));
    diagnosis.causes[0].finding.effect = "flicker_missing";
    diagnosis.causes[0].finding.entries = {{"flicker_missing", {"x"}, {{"B_dps", 0.002}}, ""}};
    diagnosis.causes[0].finding.sd = {{{"B_dps", 0.0004}}};
    EXPECT_THAT(joined(diagnosis_text(diagnosis)),
                HasSubstr("where `analyze` gives B as an upper limit (\"<\") only, the model that it writes "
                          "has B = 0. This says that 0 is too little; a size below that limit contradicts "
                          "nothing."));
}

TEST(DiagnosisText, HasSizesInItsFirstLineWhereTheyFit) {
    Diagnosis diagnosis = with_line_of_model();
    EXPECT_EQ(verdict_line(diagnosis), verdict_sentence(diagnosis)) << "two causes are too long with sizes";
    diagnosis.causes.erase(diagnosis.causes.begin());
    EXPECT_EQ(verdict_line(diagnosis), "partly: line_absent on z (31 Hz) explains 83 % of the gap");
}

// What one asks first comes first.
TEST(DiagnosisText, SaysItInTheOrderInWhichOneAsks) {
    Diagnosis diagnosis = partly();
    diagnosis.untestable = {{"latency", "the recording has no reference rate"}};
    const std::string text = diagnosis_text(diagnosis);
    std::size_t before = 0;
    for (const char* part :
         {"partly: ", "\ngap: ", "\nexplained: ", "cause     axes  size", "\n  1. temp_lag  x     ",
          "\nleft: ", "\nwhat to do next\n", "\nwhat the causes are\n  1. The output follows",
          "\ncompared: night.csv", "\nparameters of the causes\n", "\nwhere (1 is the floor",
          "\nnot tested\n", "\nwarnings\n"}) {
        const std::size_t at = text.find(part, before);
        ASSERT_NE(at, std::string::npos) << part << "\n" << text;
        before = at;
    }
}

// What one reads first has no word that only the method knows.
TEST(DiagnosisText, IsBriefWithoutDetailsAndWithoutTheMethodsWords) {
    Diagnosis diagnosis = partly();
    diagnosis.untestable = {{"latency", "the recording has no reference rate"}};
    const std::string brief = diagnosis_text(diagnosis, Wording::brief);
    for (const char* word : {"nats", "floor", "comes back", "not tested", "parameters of the causes"}) {
        EXPECT_THAT(brief, Not(HasSubstr(word)));
    }
    // All else is as it was.
    for (const char* part :
         {"partly: ", "\ngap: ", "\nexplained: ", "temp_lag on x", "\nleft: ", "\nwarnings\n"}) {
        EXPECT_THAT(brief, HasSubstr(part));
    }
}

TEST(DiagnosisText, SaysWhetherThereIsAGapAndHowFarItIs) {
    const std::string text = joined(diagnosis_text(known()));
    EXPECT_THAT(text, HasSubstr("1 of 5000 would differ as much (p = 0.0002)"));
    EXPECT_THAT(text,
                HasSubstr("gap: The recording is 4.1 times as far from a simulation as two simulations are "
                          "from each other (3.6 to 4.7). It differs most here: x axis, averaging times "
                          "60 s to 15 min."));
}

TEST(DiagnosisText, HasATableOfTheCausesWithSizeShareAndProbability) {
    const std::string text = diagnosis_text(partly());
    EXPECT_THAT(text,
                HasSubstr("explained: 83 % of the gap (79 % to 86 %), measured by simulating, on parts of\n"
                          "the recording that the fit did not use\n"
                          "     cause     axes  size                       share of gap     probability\n"
                          "  1. temp_lag  x     0.0210 ± 0.0020 deg/s per  62 % (55 to 68)  91 %\n"
                          "                       degC\n"
                          "                     6.8 ± 1.0 min\n"
                          "\n"
                          "left: "));
    EXPECT_THAT(joined(text),
                HasSubstr("what the causes are 1. The output follows the temperature late, 0.0210 ± "
                          "0.0020 deg/s per degC, with a lag of 6.8 ± 1.0 min. "
                          "This recording cannot tell it from `temp_linear`."));
    EXPECT_THAT(joined(text), HasSubstr("1. temp_lag: evidence 140 nats; `temp_linear` has 2.1 nats less"));
    EXPECT_THAT(text, Not(HasSubstr("may overlap")));
}

TEST(DiagnosisText, HasARowOfTheTableForEachCause) {
    const std::string text = diagnosis_text(with_line_of_model());
    EXPECT_THAT(text, HasSubstr("\n  2. line_absent  z     31 Hz "));
    EXPECT_THAT(text, HasSubstr("20 % (10 to 30)  98 %\n"));
    EXPECT_THAT(joined(text), HasSubstr("2. The model has a line at 31 Hz that the recording lacks."));
    EXPECT_THAT(joined(text),
                HasSubstr("Each share is what returns when that cause alone is taken out again: "
                          "shares may overlap."));
}

// Axes that have more or less of a cause have lines of their own.
TEST(DiagnosisText, HasASizeForEachAxisThatHasItsOwn) {
    Diagnosis diagnosis = known();
    diagnosis.causes[0].finding = different_axes();
    const std::string text = diagnosis_text(diagnosis);
    EXPECT_THAT(text, HasSubstr("  1. temp_lag  x     0.0210 ± 0.0020 deg/s per  97 % (90 to 100)  91 %\n"));
    EXPECT_THAT(text, HasSubstr("\n               z     0.0500 ± 0.0010 deg/s per\n"));
    const std::vector<CauseSize> sizes = cause_sizes(diagnosis.causes[0]);
    ASSERT_EQ(sizes.size(), 2U);
    EXPECT_EQ(sizes[0].axes, "x");
    EXPECT_EQ(sizes[1].axes, "z");
    diagnosis.causes[0].finding.entries[1].params = diagnosis.causes[0].finding.entries[0].params;
    diagnosis.causes[0].finding.sd[1] = diagnosis.causes[0].finding.sd[0];
    ASSERT_EQ(cause_sizes(diagnosis.causes[0]).size(), 1U);
    EXPECT_EQ(cause_sizes(diagnosis.causes[0])[0].axes, "x, z");
}

TEST(DiagnosisText, NamesAValueOfTheTableThatHasNoUnit) {
    Diagnosis diagnosis = known();
    Finding& finding = diagnosis.causes[0].finding;
    finding.effect = "arw_scale";
    finding.entries = {{"arw_scale", {"x", "y", "z"}, {{"factor", 1.45}}, ""}};
    finding.sd = {{{"factor", 0.01}}};
    finding.where = {};
    finding.where.axes = {0, 1, 2};
    EXPECT_THAT(diagnosis_text(diagnosis), HasSubstr("  1. arw_scale  x, y, z  factor 1.450 ± 0.010"));
}

TEST(DiagnosisText, SaysOnWhatTheSharesWereMeasured) {
    Diagnosis diagnosis = known();
    diagnosis.not_held_out = {"rtn", "tone"};
    EXPECT_THAT(
        joined(diagnosis_text(diagnosis)),
        HasSubstr("on parts of the recording that the fit did not use; not so rtn and tone, for which "
                  "the data of the fit were used"));
    diagnosis.held_out = "day2.csv";
    EXPECT_THAT(joined(diagnosis_text(diagnosis)),
                HasSubstr("measured by simulating, on day2.csv, which had no part in the fit"));
}

TEST(DiagnosisText, SaysOfASecondRecordingHowFarItIs) {
    for (Diagnosis diagnosis : {known(), none()}) {
        diagnosis.held_out = "day2.csv";
        diagnosis.gap_before = {4.1, 1.0, 3.6, 4.7};
        EXPECT_THAT(
            joined(diagnosis_text(diagnosis)),
            HasSubstr("day2.csv is 4.1 times as far from a simulation as two simulations are from each "
                      "other (3.6 to 4.7)."));
    }
}

TEST(DiagnosisText, HasNoNegativeZero) {
    Diagnosis diagnosis = partly();
    diagnosis.causes[0].share = {-0.004, -0.2, 0.1};
    EXPECT_THAT(joined(diagnosis_text(diagnosis)), HasSubstr("0 % (-20 to 10)"));
}

TEST(DiagnosisText, HasTheDetailsAtItsEnd) {
    const std::string text = joined(diagnosis_text(known()));
    EXPECT_THAT(text, HasSubstr("the recording has no reference rate: scale_factor, latency - it is too"));
    EXPECT_THAT(text, HasSubstr("One sweep of the temperature."));
    EXPECT_THAT(text, HasSubstr("warnings - a warning"));
    EXPECT_THAT(text, HasSubstr("x Allan deviation 5.2 1 2 of 3 0 of 3"));
}

TEST(DiagnosisText, SaysEveryKindOfPlace) {
    Place place;
    place.axes = {1, 2};
    place.freq_hz = Span{40.0191, 40.0192};
    place.time_s = Span{1500.0, 1500.0};
    EXPECT_EQ(place_text(place), "y and z axes, at 40.02 Hz, at 25 min after the first sample");
    place = {};
    place.freq_hz = Span{0.01, 5.0};
    place.acceleration = true;
    place.rate_rad_s = Span{10.0 * rad_per_deg, 200.0 * rad_per_deg};
    place.amplitude_sigma = Span{3.0, 9.0};
    place.structure = "duplicated_samples";
    EXPECT_EQ(place_text(place),
              "10 mHz to 5 Hz, with the specific force, rates of 10 to 200 deg/s, samples 3 to 9 standard "
              "deviations off, duplicated samples");
    EXPECT_EQ(place_text({}), "");
}

TEST(DiagnosisText, SaysWhatIsLeftAndWhere) {
    EXPECT_THAT(
        joined(diagnosis_text(partly())),
        HasSubstr("left: 17 % of the gap, 3 % beside what has no name; the gap is 7.9, 3.4 with the "
                  "causes, 1.1 with what has no name as well (1 is what two simulations differ by); "
                  "chance leaves as much in less than 1 in a million (p < 1e-6) - without a name, a "
                  "spectrum (z axis, 31 Hz to 31.8 Hz): 21 % of the gap - z axis, from 6.7 min to 6.82 "
                  "min after the first sample: 2.1 times what two simulations differ by"));
    EXPECT_THAT(
        joined(diagnosis_text(known())),
        HasSubstr("left: 3 % of the gap; the gap is 4.1, 1.1 with the causes (1 is what two simulations "
                  "differ by); chance leaves as much in 40 of 100 (p = 0.4) - no place stands out"));
    Diagnosis nothing = partly();
    nothing.verdict = Verdict::unexplained;
    nothing.causes.clear();
    nothing.unnamed.clear();
    nothing.shrink = {};
    const std::string text = joined(diagnosis_text(nothing));
    EXPECT_THAT(text,
                HasSubstr("explained: nothing, no known effect makes such a gap left: 100 % of the gap; "
                          "the gap is 7.9 (1 is what two simulations differ by) - z axis"));
    EXPECT_THAT(text, Not(HasSubstr("parameters of the causes")));
}

TEST(DiagnosisText, SaysEveryUnnamedFormInWords) {
    std::set<std::string> said;
    for (const char* form : {"density", "drift", "temperature", "rate", "level", "masked"}) {
        Diagnosis diagnosis = partly();
        diagnosis.unnamed = {{form, {}, 0.21}};
        const std::string text = joined(diagnosis_text(diagnosis));
        const std::size_t at = text.find("without a name, ");
        ASSERT_NE(at, std::string::npos) << form;
        const std::string words = text.substr(at, text.find(':', at) - at);
        EXPECT_THAT(words, HasSubstr(form == std::string("masked") ? "left out" : "a ")) << form;
        said.insert(words);
    }
    EXPECT_EQ(said.size(), 6U);
}

TEST(DiagnosisText, SaysWhichShapeFitsBetterThanTheCauses) {
    Diagnosis diagnosis = known();
    diagnosis.verdict = Verdict::unexplained;
    diagnosis.better_shape = BetterShape{"A course that repeats every 412 s", {"temp_lag"}, 12.4};
    const std::string text = joined(diagnosis_text(diagnosis));
    EXPECT_THAT(text, StartsWith("unexplained: temp_lag on x resembles the gap, but"));
    EXPECT_THAT(text, HasSubstr("A course that repeats every 412 s fits better than temp_lag, "
                                "and is no known effect."));
    const json shape = json::parse(diagnosis_json(diagnosis)).at("better_shape");
    EXPECT_EQ(shape.at("words"), "A course that repeats every 412 s");
    EXPECT_EQ(shape.at("than"), json({"temp_lag"}));
    EXPECT_EQ(shape.at("evidence_nats"), 12.4);
    EXPECT_FALSE(json::parse(diagnosis_json(known())).contains("better_shape"));
}

TEST(DiagnosisText, SaysWhatTheModelsNoiseIsWithoutTheCauses) {
    Diagnosis diagnosis = known();
    EXPECT_THAT(diagnosis_text(diagnosis), Not(HasSubstr("held part")));
    EXPECT_FALSE(json::parse(diagnosis_json(diagnosis)).contains("noise_refitted"));
    diagnosis.noise_refits.push_back(
        {1, 'B', 0.0084 * rad_per_deg, 0.00152 * rad_per_deg, 0.0002 * rad_per_deg});
    EXPECT_THAT(joined(diagnosis_text(diagnosis)), HasSubstr("B of y 0.00152 ± 0.0002 instead of 0.0084"));
    const json entry = json::parse(diagnosis_json(diagnosis)).at("noise_refitted").at(0);
    EXPECT_EQ(entry.at("axis"), "y");
    EXPECT_EQ(entry.at("coefficient"), "B");
    EXPECT_NEAR(entry.at("stated").get<double>(), 0.0084, 1e-12);
    EXPECT_NEAR(entry.at("fitted").get<double>(), 0.00152, 1e-12);
    EXPECT_NEAR(entry.at("sd").get<double>(), 0.0002, 1e-12);
}

TEST(DiagnosisText, SaysHowALongRecordingWasLookedAt) {
    EXPECT_THAT(diagnosis_text(known()), Not(HasSubstr("looked")));
    EXPECT_FALSE(json::parse(diagnosis_json(known())).contains("looks"));
    Diagnosis diagnosis = known();
    diagnosis.passes = {{1200.0, 1'200'000, 1, Verdict::none, 0.4},
                        {86400.0, 864'000, 100, Verdict::known, 1e-9}};
    EXPECT_THAT(joined(diagnosis_text(diagnosis)),
                HasSubstr("; looked at the first 20 min sample by sample and at all of it in means of 100 "
                          "samples"));
    const json looks = json::parse(diagnosis_json(diagnosis)).at("looks");
    EXPECT_EQ(looks.at(0), json::parse(R"({"duration_s": 1200.0, "rows": 1200000, "samples_per_row": 1,
                                           "verdict": "none", "p_none": 0.4})"));
    EXPECT_EQ(looks.at(1).at("verdict"), "known");
    EXPECT_EQ(looks.at(1).at("samples_per_row"), 100);
}

TEST(DiagnosisText, StatesTheReferenceBeforeTheSensorIsJudged) {
    EXPECT_THAT(diagnosis_text(known()), Not(HasSubstr("reference:")));
    EXPECT_FALSE(json::parse(diagnosis_json(known())).contains("reference"));
    Diagnosis diagnosis = known();
    diagnosis.axes = {0};
    diagnosis.passes = {{30.0, 8'571, 1, Verdict::none, 0.4, true}, {200.0, 4'000, 14, Verdict::known, 1e-9}};
    diagnosis.reference = ReferenceQuality{.is_orientation = true,
                                           .samples_per_row = 14,
                                           .error_rad_s = {Span{0.5 * rad_per_deg, 2.0 * rad_per_deg}},
                                           .latency_s = 4.5e-3,
                                           .latency_sd_s = 0.1e-3,
                                           .bandwidth_hz = 7.3};
    const std::string text = joined(diagnosis_text(diagnosis));
    const std::size_t at = text.find(
        "reference: The rates of the orientation are off by 0.5 to 2 deg/s on x (one sigma of a mean of 14 "
        "samples), and follow the sensor up to 7.3 Hz. The sensor is 4.50 ± 0.10 ms behind them: which of "
        "the "
        "two is late nobody can tell. What is noise of the sensor shows at rest only.");
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_LT(at, text.find("gap:"));
    EXPECT_THAT(text, HasSubstr("looked at 30 s of rest sample by sample and at all of it in means of 14"));
    const json told = json::parse(diagnosis_json(diagnosis));
    EXPECT_EQ(told.at("reference").at("samples_per_row"), 14);
    EXPECT_NEAR(told.at("reference").at("error_dps").at("x").at(1).get<double>(), 2.0, 1e-9);
    EXPECT_EQ(told.at("reference").at("latency_s"), 4.5e-3);
    EXPECT_EQ(told.at("looks").at(0).at("at_rest"), true);
    EXPECT_FALSE(told.at("looks").at(1).contains("at_rest"));
    EXPECT_EQ(told.at("reference").at("of"), "orientation");
}

TEST(DiagnosisText, StatesTheNoiseOfReferenceRates) {
    Diagnosis diagnosis = known();
    diagnosis.axes = {0, 1};
    const Span noise_rad_s{0.05 * rad_per_deg, 0.05 * rad_per_deg};
    diagnosis.reference = ReferenceQuality{.is_known_at_rest = true,
                                           .error_rad_s = {noise_rad_s},
                                           .latency_s = -2.0e-3,
                                           .latency_sd_s = 0.1e-3,
                                           .bandwidth_hz = 12.0};
    EXPECT_THAT(joined(diagnosis_text(diagnosis)),
                HasSubstr("reference: The reference rates are off by 0.05 deg/s on x (one sigma of a sample, "
                          "where the sensor rests), and follow the sensor up to 12 Hz. The sensor is 2.00 ± "
                          "0.10 ms ahead of them: which of the two is late nobody can tell."));
    EXPECT_EQ(json::parse(diagnosis_json(diagnosis)).at("reference").at("of"), "rates");
}

TEST(DiagnosisText, OfManyPlacesListsThoseThatStandOut) {
    Diagnosis diagnosis = known();
    diagnosis.domains.assign(9, allan_domain());
    for (std::size_t i = 0; i < 9; ++i) { diagnosis.domains[i].name = "place " + std::to_string(i); }
    diagnosis.domains[3].stands_out = diagnosis.domains[5].stands_out = true;
    const std::string text = diagnosis_text(diagnosis);
    for (std::size_t i = 0; i < 9; ++i) {
        const bool is_listed = text.find("place " + std::to_string(i)) != std::string::npos;
        EXPECT_EQ(is_listed, i == 3 || i == 5) << i;
    }
    EXPECT_THAT(text, HasSubstr("nothing stands out in 7 other comparisons"));
    for (GapDomain& domain : diagnosis.domains) { domain.stands_out = false; }
    EXPECT_THAT(diagnosis_text(diagnosis), HasSubstr("nothing stands out in any of 9 comparisons"));
}

TEST(DiagnosisText, OfNoGapClaimsNoPlaceAndNoCause) {
    const std::string text = joined(diagnosis_text(none()));
    EXPECT_THAT(text, HasSubstr("43 of 100 would differ as much (p = 0.43)"));
    for (const char* claim : {"as far from a simulation", "explained", "left: ", "causes"}) {
        EXPECT_THAT(text, Not(HasSubstr(claim)));
    }
}

TEST(DiagnosisText, KeepsItsLinesWithinATerminal) {
    Diagnosis diagnosis = with_line_of_model();
    diagnosis.causes[0].finding = different_axes();
    diagnosis.not_held_out = {"rtn", "tone", "temp_lag"};
    diagnosis.recording_name =
        "a_rather_long_name_of_a_recording_from_the_temperature_chamber_2026-11-21.csv";
    std::istringstream lines(diagnosis_text(diagnosis));
    for (std::string line; std::getline(lines, line);) { EXPECT_LE(width_of(line), 80U) << line; }
}

}  // namespace
}  // namespace gyrolog
