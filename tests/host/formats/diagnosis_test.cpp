#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/chain.hpp"
#include "host/formats/diagnosis_json.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/place_text.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Finding late_temperature() {
    Finding finding;
    finding.effect = "temp_lag";
    finding.entries = {{"temp_lag", {"x"}, {{"c1_dps_per_C", 0.021}, {"tau_s", 410.0}}, ""}};
    finding.sd = {{{"c1_dps_per_C", 0.002}, {"tau_s", 60.0}}};
    finding.gain_nats = 151.0;
    finding.evidence_nats = 140.0;
    finding.axis_gain_nats = {151.0, 0.0, 0.0};
    finding.where.axes = {0};
    finding.where.temperature = true;
    finding.where.tau_s = Span{60.0, 900.0};
    return finding;
}

GapDomain allan_domain() {
    GapDomain domain;
    domain.name = "Allan deviation";
    domain.x = {1.0, 10.0, 100.0};
    domain.recording = {1.0, 2.0, 3.0};
    domain.before_lo = {0.9, 0.9, 0.9};
    domain.before_hi = {1.1, 1.1, 1.1};
    domain.after_lo = {0.9, 1.9, 2.9};
    domain.after_hi = {1.1, 2.1, 3.1};
    domain.outside_before = {false, true, true};
    domain.outside_after = {false, false, false};
    domain.gap_before = 5.2;
    domain.gap_after = 1.02;
    return domain;
}

Diagnosis known() {
    Diagnosis diagnosis;
    diagnosis.recording_name = "night.csv";
    diagnosis.model_name = "model.json";
    diagnosis.duration_s = 7200.0;
    diagnosis.rate_hz = 100.0;
    diagnosis.samples = 720'000;
    diagnosis.simulations = 200;
    diagnosis.seed = 7;
    diagnosis.axes = {0, 1, 2};
    diagnosis.verdict = Verdict::known;
    diagnosis.p_none = 0.0002;
    diagnosis.p_left = 0.4;
    Cause cause;
    cause.finding = late_temperature();
    cause.score = 0.91;
    cause.tie_group = {{"temp_lag", 0.0}, {"temp_linear", 2.1}};
    cause.share = {0.97, 0.9, 1.0};
    cause.decided_by = "one up-and-down sweep of 5 degC";
    diagnosis.causes = {cause};
    diagnosis.where.axes = {0};
    diagnosis.where.tau_s = Span{60.0, 900.0};
    diagnosis.gap_before = {4.1, 1.0, 3.6, 4.7};
    diagnosis.gap_named = diagnosis.gap_after = {1.1, 1.0, 0.9, 1.4};
    diagnosis.shrink = {0.97, 0.93, 1.0};
    diagnosis.shrink_modelled = 0.97;
    diagnosis.domains = {allan_domain()};
    diagnosis.untestable = {{"scale_factor", "the recording has no reference rate"},
                            {"rtn", "it is too short"},
                            {"latency", "the recording has no reference rate"}};
    diagnosis.next_recordings = {"One sweep of the temperature."};
    diagnosis.warnings = {"a warning"};
    return diagnosis;
}

// The contract's example.
Diagnosis partly() {
    Diagnosis diagnosis = known();
    diagnosis.verdict = Verdict::partly;
    diagnosis.p_left = 1e-9;
    diagnosis.causes[0].share = {0.62, 0.55, 0.68};
    diagnosis.unnamed = {{"density", {}, 0.21}};
    diagnosis.unnamed[0].where.axes = {2};
    diagnosis.unnamed[0].where.freq_hz = Span{31.0, 31.8};
    diagnosis.left = {{{}, 2.1}};
    diagnosis.left[0].where.axes = {2};
    diagnosis.left[0].where.time_s = Span{402.0, 409.0};
    diagnosis.gap_before = {7.9, 1.0, 7.1, 8.8};
    diagnosis.gap_named = {3.4, 1.0, 3.0, 3.9};
    diagnosis.gap_after = {1.1, 1.0, 0.9, 1.4};
    diagnosis.shrink = {0.83, 0.79, 0.86};
    diagnosis.shrink_modelled = 0.97;
    return diagnosis;
}

// A line of the model at 31 Hz that the recording has not.
Diagnosis with_line_of_model() {
    Diagnosis diagnosis = partly();
    Cause cause;
    cause.sense = Sense::model_has;
    cause.score = 0.98;
    cause.share = {0.2, 0.1, 0.3};
    cause.finding.effect = "line_absent";
    cause.finding.entries = {{"tone", {"z"}, {{"f_hz", 31.0}, {"amplitude_dps", 0.05}}, ""}};
    cause.finding.sd = {{}};
    cause.finding.where.axes = {2};
    cause.finding.where.freq_hz = Span{30.9, 31.1};
    diagnosis.causes.push_back(cause);
    return diagnosis;
}

Diagnosis none() {
    Diagnosis diagnosis = known();
    diagnosis.verdict = Verdict::none;
    diagnosis.p_none = 0.43;
    diagnosis.causes.clear();
    diagnosis.where = {};
    diagnosis.gap_before = diagnosis.gap_named = diagnosis.gap_after = {1.02, 1.0, 0.8, 1.2};
    diagnosis.shrink = {};
    diagnosis.shrink_modelled = 0.0;
    for (GapDomain& domain : diagnosis.domains) {
        domain.after_lo.clear();
        domain.after_hi.clear();
        domain.outside_after.clear();
    }
    return diagnosis;
}

// Two axes, of which the second has more of the effect.
Finding different_axes() {
    Finding finding = late_temperature();
    finding.entries.push_back({"temp_lag", {"z"}, {{"c1_dps_per_C", 0.05}, {"tau_s", 410.0}}, ""});
    finding.sd.push_back({{"c1_dps_per_C", 0.001}, {"tau_s", 60.0}});
    finding.axis_gain_nats = {20.0, 0.0, 130.0};
    finding.where.axes = {0, 2};
    return finding;
}

// What the contract asks for: every key with its type; '?' marks keys that need not be there.
void expect_keys(const json& object, const std::map<std::string, std::string>& types,
                 const std::string& where) {
    ASSERT_TRUE(object.is_object()) << where;
    for (const auto& [name, type] : types) {
        const bool may_lack = name.ends_with('?');
        const std::string key = may_lack ? name.substr(0, name.size() - 1) : name;
        if (may_lack && !object.contains(key)) { continue; }
        ASSERT_TRUE(object.contains(key)) << where << "." << key;
        const json& value = object[key];
        const std::string is = value.is_number() ? "number" : value.type_name();
        EXPECT_EQ(is, type) << where << "." << key;
    }
    for (const auto& [key, value] : object.items()) {
        EXPECT_TRUE(types.contains(key) || types.contains(key + "?")) << where << "." << key << " is unknown";
    }
}

void expect_place(const json& place, const std::string& where) {
    expect_keys(place,
                {{"axes?", "array"},
                 {"freq_hz?", "array"},
                 {"tau_s?", "array"},
                 {"time_s?", "array"},
                 {"temperature?", "boolean"},
                 {"acceleration?", "boolean"},
                 {"rate_dps?", "array"},
                 {"amplitude_sigma?", "array"},
                 {"structure?", "string"}},
                where);
    for (const char* range : {"freq_hz", "tau_s", "time_s", "rate_dps", "amplitude_sigma"}) {
        if (!place.contains(range)) { continue; }
        ASSERT_EQ(place[range].size(), 2U) << range;
        EXPECT_TRUE(place[range][0].is_number() && place[range][1].is_number()) << range;
    }
}

void expect_numbers(const json& params, const std::string& where) {
    for (const auto& [name, value] : params.items()) { EXPECT_TRUE(value.is_number()) << where << name; }
}

void expect_cause(const json& cause) {
    expect_keys(cause,
                {{"effect", "string"},
                 {"sense", "string"},
                 {"score", "number"},
                 {"tie_group", "array"},
                 {"axes", "array"},
                 {"where", "object"},
                 {"params", "object"},
                 {"sd", "object"},
                 {"share", "number"},
                 {"share_lo", "number"},
                 {"share_hi", "number"},
                 {"sentence", "string"},
                 {"gain_nats", "number"},
                 {"evidence_nats", "number"},
                 {"params_by_axis?", "object"},
                 {"sd_by_axis?", "object"},
                 {"tie?", "object"},
                 {"decided_by?", "string"}},
                "cause");
    EXPECT_TRUE(cause["sense"] == "recording_has" || cause["sense"] == "model_has") << cause["sense"];
    EXPECT_EQ(cause["tie_group"].at(0), cause["effect"]);
    expect_place(cause["where"], "cause.where");
    expect_numbers(cause["params"], "params.");
    expect_numbers(cause["sd"], "sd.");
}

void expect_schema(const json& answer) {
    expect_keys(answer,
                {{"schema", "string"},
                 {"verdict", "string"},
                 {"p_none", "number"},
                 {"p_left", "number"},
                 {"causes", "array"},
                 {"unnamed", "array"},
                 {"left", "array"},
                 {"where", "object"},
                 {"gap_before", "object"},
                 {"gap_named", "object"},
                 {"gap_after", "object"},
                 {"shrink", "number"},
                 {"shrink_lo", "number"},
                 {"shrink_hi", "number"},
                 {"shrink_modelled", "number"},
                 {"held_out", "string"},
                 {"not_held_out", "array"},
                 {"recording", "string"},
                 {"model", "string"},
                 {"rate_hz", "number"},
                 {"duration_s", "number"},
                 {"samples", "number"},
                 {"axes", "array"},
                 {"simulations", "number"},
                 {"seed", "number"},
                 {"domains", "array"},
                 {"band_probability", "number"},
                 {"untestable", "array"},
                 {"next_recordings", "array"},
                 {"warnings", "array"},
                 {"reported_by", "string"}},
                "answer");
    EXPECT_EQ(answer["schema"], "gyrolog-diagnosis/2");
    for (const char* gap : {"gap_before", "gap_named", "gap_after"}) {
        expect_keys(answer[gap],
                    {{"value", "number"}, {"floor", "number"}, {"lo", "number"}, {"hi", "number"}}, gap);
    }
    for (const json& one : answer["unnamed"]) {
        expect_keys(one, {{"form", "string"}, {"axes", "array"}, {"where", "object"}, {"share", "number"}},
                    "unnamed");
        expect_place(one["where"], "unnamed.where");
    }
    for (const json& one : answer["left"]) {
        expect_keys(one, {{"where", "object"}, {"size", "number"}}, "left");
        expect_place(one["where"], "left.where");
    }
    expect_place(answer["where"], "where");
    for (const json& cause : answer["causes"]) { expect_cause(cause); }
    for (const json& domain : answer["domains"]) {
        expect_keys(domain,
                    {{"name", "string"},
                     {"axis", "string"},
                     {"points", "number"},
                     {"outside_before", "number"},
                     {"gap_before", "number"},
                     {"outside_after?", "number"},
                     {"gap_after?", "number"}},
                    "domain");
    }
    for (const json& one : answer["untestable"]) {
        expect_keys(one, {{"effect", "string"}, {"why", "string"}}, "untestable");
    }
}

TEST(DiagnosisJson, HasEveryKeyOfTheContractWithItsType) {
    expect_schema(json::parse(diagnosis_json(known())));
    expect_schema(json::parse(diagnosis_json(partly())));
    expect_schema(json::parse(diagnosis_json(with_line_of_model())));
    expect_schema(json::parse(diagnosis_json(none())));
    Diagnosis several = known();
    several.verdict = Verdict::unexplained;
    several.causes[0].finding = different_axes();
    several.causes.push_back(known().causes[0]);
    several.causes[1].tie_group.clear();
    expect_schema(json::parse(diagnosis_json(several)));
    expect_schema(json::parse(diagnosis_json(Diagnosis{})));
}

// Every key of the contract with its value; what else is there may be there.
TEST(DiagnosisJson, SaysTheContractsExample) {
    const json contract = json::parse(R"({
        "schema": "gyrolog-diagnosis/2",
        "verdict": "partly",
        "p_none": 0.0002,
        "causes": [
          {
            "effect": "temp_lag",
            "sense": "recording_has",
            "score": 0.91,
            "tie_group": ["temp_lag", "temp_linear"],
            "axes": ["x"],
            "where": {"temperature": true, "tau_s": [60.0, 900.0]},
            "params": {"c1_dps_per_C": 0.021, "tau_s": 410.0},
            "sd": {"c1_dps_per_C": 0.002, "tau_s": 60.0},
            "share": 0.62, "share_lo": 0.55, "share_hi": 0.68
          }
        ],
        "unnamed": [{"form": "density", "axes": ["z"], "where": {"freq_hz": [31.0, 31.8]}, "share": 0.21}],
        "left": [{"where": {"axes": ["z"], "time_s": [402.0, 409.0]}, "size": 2.1}],
        "where": {"axes": ["x"], "tau_s": [60.0, 900.0]},
        "gap_before": {"value": 7.9, "floor": 1.0, "lo": 7.1, "hi": 8.8},
        "gap_named":  {"value": 3.4, "floor": 1.0, "lo": 3.0, "hi": 3.9},
        "gap_after":  {"value": 1.1, "floor": 1.0, "lo": 0.9, "hi": 1.4},
        "shrink": 0.83, "shrink_lo": 0.79, "shrink_hi": 0.86,
        "shrink_modelled": 0.97
    })");
    const json answer = json::parse(diagnosis_json(partly()));
    for (const auto& [key, value] : contract.items()) {
        if (key != "causes") { EXPECT_EQ(answer.at(key), value) << key; }
    }
    ASSERT_EQ(answer["causes"].size(), 1U);
    for (const auto& [key, value] : contract["causes"][0].items()) {
        EXPECT_EQ(answer["causes"][0].at(key), value) << key;
    }
    EXPECT_EQ(answer["domains"][0]["outside_before"], 2);
    EXPECT_EQ(answer["untestable"].size(), 3U);
    EXPECT_EQ(answer["not_held_out"], json::array());
}

TEST(DiagnosisJson, NamesEveryVerdictAndSense) {
    EXPECT_EQ(name_of(Verdict::none), "none");
    EXPECT_EQ(name_of(Verdict::known), "known");
    EXPECT_EQ(name_of(Verdict::partly), "partly");
    EXPECT_EQ(name_of(Verdict::unexplained), "unexplained");
    Diagnosis diagnosis = with_line_of_model();
    diagnosis.not_held_out = {"rtn"};
    const json answer = json::parse(diagnosis_json(diagnosis));
    EXPECT_EQ(answer["causes"][0]["sense"], "recording_has");
    EXPECT_EQ(answer["causes"][1]["sense"], "model_has");
    EXPECT_EQ(answer["causes"][1]["sentence"], "The model has a line at 31 Hz that the recording lacks");
    EXPECT_EQ(answer["not_held_out"], json({"rtn"}));
}

TEST(DiagnosisJson, PutsEveryKindOfPlaceUnderItsKeyInItsUnit) {
    Diagnosis diagnosis = known();
    Place& place = diagnosis.where;
    place.axes = {1, 2};
    place.freq_hz = Span{12.4, 12.6};
    place.time_s = Span{1500.0, 1500.0};
    place.acceleration = true;
    place.rate_rad_s = Span{10.0 * rad_per_deg, 200.0 * rad_per_deg};
    place.amplitude_sigma = Span{3.0, 9.0};
    place.structure = "code_grid";
    const json where = json::parse(diagnosis_json(diagnosis))["where"];
    EXPECT_EQ(where["axes"], json({"y", "z"}));
    EXPECT_EQ(where["freq_hz"], json({12.4, 12.6}));
    EXPECT_EQ(where["time_s"], json({1500.0, 1500.0}));
    EXPECT_EQ(where["acceleration"], true);
    EXPECT_NEAR(where["rate_dps"][0].get<double>(), 10.0, 1e-9);
    EXPECT_NEAR(where["rate_dps"][1].get<double>(), 200.0, 1e-9);
    EXPECT_EQ(where["amplitude_sigma"], json({3.0, 9.0}));
    EXPECT_EQ(where["structure"], "code_grid");
    EXPECT_FALSE(where.contains("temperature"));
}

TEST(DiagnosisJson, GivesTheParametersOfTheStrongestAxisAndThoseOfAll) {
    Diagnosis diagnosis = known();
    diagnosis.causes[0].finding = different_axes();
    const json cause = json::parse(diagnosis_json(diagnosis))["causes"][0];
    EXPECT_EQ(cause["axes"], json({"x", "z"}));
    EXPECT_EQ(cause["params"]["c1_dps_per_C"], 0.05);
    EXPECT_EQ(cause["sd"]["c1_dps_per_C"], 0.001);
    EXPECT_EQ(cause["params_by_axis"]["x"]["c1_dps_per_C"], 0.021);
    EXPECT_EQ(cause["params_by_axis"]["z"]["c1_dps_per_C"], 0.05);
    EXPECT_EQ(cause["sd_by_axis"]["x"]["c1_dps_per_C"], 0.002);
    EXPECT_FALSE(json::parse(diagnosis_json(known()))["causes"][0].contains("params_by_axis"));
}

TEST(DiagnosisText, SaysTheVerdictInItsFirstLine) {
    EXPECT_THAT(diagnosis_text(known()), StartsWith("known: temp_lag on x explains the gap\n"));
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
    EXPECT_EQ(verdict_sentence(many), "known: temp_lag on x, tone on y and z and 4 more explain the gap");
    many.causes.resize(3);
    EXPECT_EQ(verdict_sentence(many),
              "known: temp_lag on x, tone on y and z and temp_lag on x explain the gap");
}

std::string joined(const std::string& text) {
    std::string line;
    for (const char c : text) {
        if (c != '\n' && c != ' ') {
            line += c;
        } else if (!line.ends_with(' ')) {
            line += ' ';
        }
    }
    return line;
}

// What one asks first comes first.
TEST(DiagnosisText, SaysItInTheOrderInWhichOneAsks) {
    Diagnosis diagnosis = partly();
    diagnosis.untestable = {{"latency", "the recording has no reference rate"}};
    const std::string text = diagnosis_text(diagnosis);
    std::size_t before = 0;
    for (const char* part : {"partly: ", "\ngap\n", "\nexplained: ", "\n  1. temp_lag on x: ", "\nleft: ",
                             "\nrecordings that would tell more\n", "\nparameters of the causes\n",
                             "\nwhere (1 is the floor", "\nnot tested\n", "\nwarnings\n"}) {
        const std::size_t at = text.find(part, before);
        ASSERT_NE(at, std::string::npos) << part << "\n" << text;
        before = at;
    }
}

TEST(DiagnosisText, SaysWhetherThereIsAGapAndHowFarItIs) {
    const std::string text = joined(diagnosis_text(known()));
    EXPECT_THAT(text, HasSubstr("1 of 5000 would differ as much (p = 0.0002)"));
    EXPECT_THAT(text, HasSubstr("The recording is 4.1 times as far from a simulation as two simulations are "
                                "from each other (3.6 to 4.7). It differs most here: x axis, averaging times "
                                "60 s to 15 min."));
}

TEST(DiagnosisText, HasALineForEachCauseWithItsShareAndProbability) {
    const std::string text = joined(diagnosis_text(partly()));
    EXPECT_THAT(text,
                HasSubstr("explained: 83 % of the gap (79 % to 86 %), measured by simulating, on parts of "
                          "the recording that the fit did not use 1. temp_lag on x: 62 % of the gap (55 % "
                          "to 68 %), probability 91 %. The output follows the temperature late, 0.0210 ± "
                          "0.0020 deg/s per degC with a lag of 6.8 ± 1.0 min and a play of 0 degC. This "
                          "recording cannot tell it from `temp_linear`."));
    EXPECT_THAT(text, Not(HasSubstr("may overlap")));
    EXPECT_THAT(text, HasSubstr("1. temp_lag: evidence 140 nats; `temp_linear` has 2.1 nats less"));
    EXPECT_THAT(text, HasSubstr("tau_s 6.8 ± 1.0 min"));
    EXPECT_THAT(
        joined(diagnosis_text(with_line_of_model())),
        HasSubstr("2. line_absent on z: 20 % of the gap (10 % to 30 %), probability 98 %. The model has "
                  "a line at 31 Hz that the recording lacks. Each share is what comes back when that "
                  "cause alone is taken out again: shares may overlap."));
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
    EXPECT_THAT(text, HasSubstr("A course that repeats every 412 s fits better than temp_lag, by 12 nats, "
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

TEST(DiagnosisText, OfManyPlacesListsThoseThatStandOut) {
    Diagnosis diagnosis = known();
    diagnosis.domains.assign(9, allan_domain());
    for (std::size_t i = 0; i < 9; ++i) { diagnosis.domains[i].name = "place " + std::to_string(i); }
    diagnosis.domains[3].surprise_before_nats = 30.0;
    diagnosis.domains[5].surprise_after_nats = 30.0;
    const std::string text = diagnosis_text(diagnosis);
    for (std::size_t i = 0; i < 9; ++i) {
        const bool is_listed = text.find("place " + std::to_string(i)) != std::string::npos;
        EXPECT_EQ(is_listed, i == 3 || i == 5) << i;
    }
    EXPECT_THAT(text, HasSubstr("nothing stands out in 7 other comparisons"));
    for (GapDomain& domain : diagnosis.domains) {
        domain.surprise_before_nats = domain.surprise_after_nats = 0.0;
    }
    EXPECT_THAT(diagnosis_text(diagnosis), HasSubstr("nothing stands out in any of 9 comparisons"));
}

TEST(DiagnosisText, OfNoGapClaimsNoPlaceAndNoCause) {
    const std::string text = diagnosis_text(none());
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
    for (std::string line; std::getline(lines, line);) { EXPECT_LE(line.size(), 112U) << line; }
}

TEST(EffectWords, WriteQuantitiesInUnitsThatPeopleLike) {
    EXPECT_EQ(quantity_text("tau_s", 410.0, 60.0, nullptr), "6.8 ± 1.0 min");
    EXPECT_EQ(quantity_text("at_s", 9000.0, 0.0, nullptr), "2.5 h");
    EXPECT_EQ(quantity_text("delay_s", 0.0032, 0.0001, nullptr), "3.20 ± 0.10 ms");
    EXPECT_EQ(quantity_text("c1_dps_per_C", 0.021, 0.002, nullptr), "0.0210 ± 0.0020 deg/s per degC");
    EXPECT_EQ(quantity_text("c1_dps_per_C", -0.0005, 0.0, nullptr), "-1.8 deg/h per degC");
    EXPECT_EQ(quantity_text("ramp_dps_per_s", 1e-4, 0.0, nullptr), "0.36 deg/s per h");
    EXPECT_EQ(quantity_text("ramp_dps_per_s", 1e-8, 0.0, nullptr), "0.13 deg/h per h");
    EXPECT_EQ(quantity_text("sigma_dps", 0.0125, 0.0, nullptr), "0.0125 deg/s");
    EXPECT_EQ(quantity_text("B_dps", 0.0005, 0.0001, nullptr), "1.80 ± 0.36 deg/h");
    EXPECT_EQ(quantity_text("f_hz", 49.97, 0.01, nullptr), "49.970 ± 0.010 Hz");
    EXPECT_EQ(quantity_text("phase_rad", pi, 0.0, nullptr), "180 deg");
    EXPECT_EQ(quantity_text("per_C", 0.012, 0.001, nullptr), "1.20 ± 0.10 % per degC");
    EXPECT_EQ(quantity_text("per_hour", 3.2, 0.0, nullptr), "3.2 per hour");
    EXPECT_EQ(quantity_text("nu", 4.0, 0.5, nullptr), "4.00 ± 0.50");
    EXPECT_EQ(quantity_text("x_dps_per_g", 0.2, 0.0, nullptr), "0.2 deg/s per g");
}

TEST(EffectWords, WriteSharesAndRelativeErrorsInPercentOrPpm) {
    const EffectParam* of_stale = find_effect("stale")->params.data();
    EXPECT_EQ(quantity_text("eps", 0.0987, 0.0, of_stale), "9.87 %");
    const EffectParam* of_clock = find_effect("clock_rate")->params.data();
    EXPECT_EQ(quantity_text("rel", 1.2e-4, 1e-5, of_clock), "120 ± 10 ppm");
    EXPECT_EQ(quantity_text("rel", -0.007, 0.0, of_clock), "-0.7 %");
}

TEST(EffectWords, PutValuesInTheirPlaces) {
    EXPECT_EQ(
        filled_words("The bias follows the temperature {tau_s} late, {c1_dps_per_C}.", late_temperature()),
        "The bias follows the temperature 6.8 ± 1.0 min late, 0.0210 ± 0.0020 deg/s per degC.");
    EXPECT_EQ(filled_words("{c1_dps_per_C}, {tau_s}", different_axes()),
              "0.0210 ± 0.0020 deg/s per degC (x), 0.0500 ± 0.0010 deg/s per degC (z), 6.8 ± 1.0 min");
    EXPECT_EQ(filled_words("a loop of {play_C}", late_temperature()), "a loop of 0 degC")
        << "the effect's own value of what was not fitted";
    EXPECT_EQ(filled_words("no values", late_temperature()), "no values");
}

Cause of_model(const std::string& name, const std::string& effect, std::map<std::string, double> params) {
    Cause cause;
    cause.sense = Sense::model_has;
    cause.finding.effect = name;
    cause.finding.entries = {{effect, {"x"}, std::move(params), ""}};
    cause.finding.sd = {{}};
    return cause;
}

TEST(EffectWords, SayWhatTheModelHasAndTheRecordingLacks) {
    EXPECT_EQ(cause_words(of_model("tone", "tone", {{"f_hz", 31.0}, {"amplitude_dps", 0.05}})),
              "The model has a line at 31 Hz that the recording lacks");
    EXPECT_EQ(cause_words(of_model("line_absent", "line_absent", {{"f_hz", 31.0}})),
              "The model has a line at 31 Hz that the recording lacks");
    EXPECT_EQ(cause_words(of_model("rrw_excess", "rrw_excess", {{"factor", 0.5}})),
              "The model has a rate random walk; the recording has 0.5 times as much");
    EXPECT_EQ(cause_words(of_model("flicker_excess", "flicker_excess", {})),
              "The model has flicker noise that the recording lacks");
    EXPECT_EQ(cause_words(of_model("arw_scale", "arw_scale", {{"factor", 0.8}})),
              "The model has white noise; the recording has 0.8 times as much");
    EXPECT_EQ(cause_words(of_model("effect_absent", "temp_linear", {{"c1_dps_per_C", 0.02}})),
              "The model has a temperature coefficient of 0.02 deg/s per degC that the recording lacks");
    EXPECT_EQ(cause_words(of_model("effect_absent", "self_heating", {})),
              "The model has `self_heating` that the recording lacks");
    EXPECT_EQ(
        cause_words(of_model("variance_change", "variance_change", {{"factor", 2.0}})),
        "The model has a change of the white noise to 2 times its standard deviation that the recording "
        "lacks");
    Cause lacking = of_model("rrw_missing", "rrw_missing", {{"K_dps_sqrt_hz", 0.002}});
    lacking.sense = Sense::recording_has;
    EXPECT_EQ(cause_words(lacking), effect_words(lacking.finding));
}

// A line may be mains, a motor, or one that somebody simulated.
TEST(EffectWords, SayWhatIsSeenAndNotWhatMadeIt) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        const std::string words(link.effect->signature->words);
        for (const char* origin :
             {"mains", "vibration", "supply", "outside", "turn-on", "read faster", "The bias"}) {
            EXPECT_THAT(words, Not(HasSubstr(origin))) << link.effect->name;
        }
    }
}

TEST(EffectWords, NameOnlyParametersThatTheEffectHas) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        for (const std::string_view words : {link.effect->signature->words, link.effect->signature->noun}) {
            EXPECT_FALSE(words.empty()) << link.effect->name;
            for (std::size_t open = words.find('{'); open != std::string_view::npos;
                 open = words.find('{', open + 1)) {
                const std::string_view name = words.substr(open + 1, words.find('}', open) - open - 1);
                EXPECT_TRUE(std::ranges::any_of(link.effect->params,
                                                [&](const EffectParam& param) { return param.name == name; }))
                    << link.effect->name << " {" << name << "}";
            }
        }
    }
}

TEST(WrappedText, BreaksAtSpacesAndCountsCharacters) {
    EXPECT_EQ(wrapped_text("- ", "one two three", 9), "- one two\n  three\n");
    EXPECT_EQ(wrapped_text("", "±± ±± ±±", 5), "±± ±±\n±±\n");
    EXPECT_EQ(wrapped_text("", "unbreakable", 3), "unbreakable\n");
    EXPECT_EQ(wrapped_text("- ", "", 9), "- \n");
}

}  // namespace
}  // namespace gyrolog
