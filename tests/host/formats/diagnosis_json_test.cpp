#include "host/formats/diagnosis_json.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/formats/diagnosis_text.hpp"
#include "tests/host/formats/diagnosis_cases.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using test::different_axes;
using test::known;
using test::none;
using test::partly;
using test::with_line_of_model;

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
    expect_keys(answer, {{"schema", "string"},    {"verdict", "string"},     {"p_none", "number"},
                         {"p_left", "number"},    {"causes", "array"},       {"unnamed", "array"},
                         {"left", "array"},       {"where", "object"},       {"gap_before", "object"},
                         {"gap_named", "object"}, {"gap_after", "object"},   {"shrink", "number"},
                         {"shrink_lo", "number"}, {"shrink_hi", "number"},   {"shrink_modelled", "number"},
                         {"held_out", "string"},  {"not_held_out", "array"}, {"recording", "string"},
                         {"model", "string"},     {"rate_hz", "number"},     {"duration_s", "number"},
                         {"samples", "number"},   {"axes", "array"},         {"simulations", "number"},
                         {"seed", "number"},      {"domains", "array"},      {"band_probability", "number"},
                         {"untestable", "array"}, {"asked?", "array"},       {"next_recordings", "array"},
                         {"warnings", "array"},   {"reported_by", "string"}},
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
TEST(DiagnosisJson, AnswersWhatWasAsked) {
    Diagnosis diagnosis;
    EXPECT_FALSE(json::parse(diagnosis_json(diagnosis)).contains("asked"));
    Asked::Answer beside;
    beside.amount = {0.9, 0.1};
    beside.is_called_for = true;
    beside.gain_nats = 40.0;
    diagnosis.asked = {{{"heater", {"time_table", {"z"}, {}, "", {}}}, beside, {}}};
    const json asked = json::parse(diagnosis_json(diagnosis))["asked"][0];
    EXPECT_EQ(asked["name"], "heater");
    EXPECT_EQ(asked["effect"], "time_table");
    EXPECT_EQ(asked["axes"], json({"z"}));
    EXPECT_EQ(asked["beside_causes"]["amount"], 0.9);
    EXPECT_EQ(asked["beside_causes"]["called_for"], true);
    EXPECT_EQ(asked["alone"]["called_for"], false);
    EXPECT_FALSE(asked["alone"].contains("amount"));
    EXPECT_NE(diagnosis_text(diagnosis).find("heater on z: the data call for it (0.90 ± 0.10 times what is "
                                             "described"),
              std::string::npos)
        << diagnosis_text(diagnosis);
}

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

}  // namespace
}  // namespace gyrolog
