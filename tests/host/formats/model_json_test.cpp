#include "host/formats/model_json.hpp"

#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* full_example = R"({
  "schema": "gyrolog-model/1",
  "rate_hz": 100.0, "full_scale_dps": 500.0, "lsb_dps": 0.015267, "saturation_dps": 500.26,
  "axes": {
    "x": {"N": 0.005, "B": 0.002, "K": 1.0e-4, "bias": 0.31, "Q": 1e-5, "R": -2e-6, "sd": {"N": 0.01}},
    "y": {"N": 0.006, "B": 0.003, "K": 2.0e-4, "bias": -0.12},
    "z": {"N": 0.007, "B": 0.004, "K": 3.0e-4, "bias": 0.08}
  },
  "M": [[1,0.01,0],[0,0.99,0],[0,0,1]],
  "latency_s": 0.001, "timestamp_jitter_s": 2.0e-5,
  "sd_rel": {"N": 0.005, "B": 0.08, "K": 0.20, "timestamp_jitter": 0.05},
  "sd_abs": {"M": 2.0e-4, "latency_s": 1.0e-4, "rate_rel": 5.0e-5},
  "ref_noise_dps": 0.02, "acc_noise_g": 0.003, "temp_noise_C": 0.03,
  "orientation": [[0,1,0],[1,0,0],[0,0,-1]],
  "misalignment_percent": [0.1, 0.2, -0.3],
  "temperature": {"reference_C": 30.5, "bias_dps_per_C": [0.01, 0.02, 0.03], "scale_percent_per_C": 0.04},
  "effects": [{"effect": "temp_lag", "axes": ["x"], "params": {"c1_dps_per_C": 0.021, "tau_s": 410}}]
})";

Json example() { return Json::parse(full_example); }

Json units_of(const std::string& rate) {
    return {{"N", rate + "/sqrt(Hz)"}, {"B", rate},    {"K", rate + "*sqrt(Hz)"}, {"Q", rate + "*s"},
            {"R", rate + "/s"},        {"bias", rate}, {"sd", "relative"},        {"sd_rel", "relative"}};
}

// The same as it is written.
Json with_units(Json json) {
    json["units"] = units_of("dps");
    if (json.contains("accelerometer")) { json["accelerometer"]["units"] = units_of("g"); }
    return json;
}

SensorModel model_of(const Json& json) {
    auto model = parse_model(json.dump(), "m.json");
    EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
    return model.ok() ? *model : SensorModel{};
}

std::string refusal_of(const std::string& text) {
    const auto model = parse_model(text, "m.json");
    return model.ok() ? "accepted" : model.error().message;
}

TEST(ModelJson, EveryKeyArrivesInSiUnits) {
    const SensorModel model = model_of(example());
    EXPECT_EQ(model.rate_hz, 100.0);
    EXPECT_DOUBLE_EQ(model.full_scale_rad_s, 500.0 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.lsb_rad_s, 0.015267 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.axes[1].noise.N_rad_per_sqrt_s, 0.006 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.axes[2].noise.B_rad_per_s, 0.004 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.axes[0].noise.K_rad_per_s_sqrt_s, 1e-4 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.axes[0].noise.Q_rad, 1e-5 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.axes[0].noise.R_rad_per_s2, -2e-6 * pi / 180.0);
    EXPECT_EQ(model.axes[0].sd_rel.at("N"), 0.01);
    EXPECT_DOUBLE_EQ(model.axes[1].bias_rad_s, -0.12 * pi / 180.0);
    EXPECT_EQ(model.M[0][1], 0.01);
    EXPECT_DOUBLE_EQ(model.acc_noise_m_s2, 0.003 * 9.80665);
    EXPECT_EQ((*model.orientation)[2][2], -1.0);
    EXPECT_DOUBLE_EQ((*model.misalignment)[2], -0.003);
    EXPECT_DOUBLE_EQ(model.temperature->bias_rad_s_per_C[1], 0.02 * pi / 180.0);
    EXPECT_DOUBLE_EQ(model.temperature->scale_per_C[2], 0.0004);
    ASSERT_EQ(model.effects.size(), 1U);
    EXPECT_EQ(model.effects[0].effect, "temp_lag");
    EXPECT_EQ(model.effects[0].params.at("tau_s"), 410.0);
}

TEST(ModelJson, WhatIsReadIsWrittenBackWithTheSameNumbers) {
    EXPECT_EQ(Json::parse(format_model(model_of(example()))), with_units(example()));
}

Json with_accelerometer() {
    Json json = example();
    json["accelerometer"] = Json::parse(R"({
      "full_scale_g": 2.0, "lsb_g": 6.1e-5, "saturation_g": 1.9999,
      "axes": {
        "x": {"N": 3e-4, "B": 2e-5, "K": 1e-6, "bias": 0.02, "Q": 1e-6, "R": -3e-9, "sd": {"N": 0.01}},
        "y": {"N": 3.1e-4, "B": 2.1e-5, "K": 1.1e-6, "bias": -0.01},
        "z": {"N": 4e-4, "B": 3e-5, "K": 2e-6, "bias": 0.05}
      },
      "M": [[1,0,0.002],[0,1.01,0],[0,0,1]],
      "sd_rel": {"N": 0.01}, "sd_abs": {"M": 1e-3},
      "effects": [{"effect": "tone", "axes": ["z"], "params": {"f_hz": 31.0, "amplitude_g": 0.002}}]
    })");
    return json;
}

TEST(ModelJson, AnAccelerometerArrivesInMetresPerSecondSquared) {
    const SensorModel model = model_of(with_accelerometer());
    ASSERT_TRUE(model.accelerometer);
    EXPECT_DOUBLE_EQ(model.accelerometer->axes[0].noise.N_rad_per_sqrt_s, 3e-4 * 9.80665);
    EXPECT_DOUBLE_EQ(model.accelerometer->axes[1].noise.B_rad_per_s, 2.1e-5 * 9.80665);
    EXPECT_DOUBLE_EQ(model.accelerometer->axes[2].noise.K_rad_per_s_sqrt_s, 2e-6 * 9.80665);
    EXPECT_DOUBLE_EQ(model.accelerometer->axes[2].bias_rad_s, 0.05 * 9.80665);
    EXPECT_DOUBLE_EQ(model.accelerometer->lsb_m_s2, 6.1e-5 * 9.80665);
    EXPECT_EQ(model.accelerometer->M[0][2], 0.002);
    EXPECT_EQ(model.accelerometer->effects.at(0).params.at("amplitude_g"), 0.002);
}

TEST(ModelJson, AnAccelerometerIsWrittenBackWithTheSameNumbersAndUnknownKeys) {
    Json json = with_accelerometer();
    EXPECT_EQ(Json::parse(format_model(model_of(json))), with_units(json));
    json["accelerometer"]["lot"] = 7;
    json["accelerometer"]["axes"]["x"]["colour"] = "red";
    json["accelerometer"]["unnamed"] = {
        {{"form", "density"}, {"axes", {"z"}}, {"table", {{"f_hz", {0.0, 50.0}}, {"factor", {1.0, 2.5}}}}}};
    EXPECT_EQ(Json::parse(format_model(model_of(json))), with_units(json));
}

TEST(ModelJson, OfAnAccelerometerAFewNumbersAreEnoughAndAWrongOneIsNamed) {
    Json json = example();
    json["accelerometer"] = {{"axes", {{"x", {{"N", 1e-4}}}, {"y", {{"N", 1e-4}}}, {"z", {{"N", 1e-4}}}}}};
    const SensorModel model = model_of(json);
    ASSERT_TRUE(model.accelerometer);
    EXPECT_EQ(model.accelerometer->M, identity_matrix);
    EXPECT_EQ(model.accelerometer->full_scale_m_s2, no_range_m_s2);
    json["accelerometer"]["axes"]["y"]["N"] = "loud";
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("accelerometer.axes.y.N"));
    json["accelerometer"] = 3;
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("accelerometer"));
    json["accelerometer"] = Json::object();
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("accelerometer.axes is missing"));
}

Json with_density(Json form) {
    Json json = example();
    json["unnamed"] = {{{"form", std::move(form)},
                        {"axes", {"z"}},
                        {"table", {{"f_hz", {0.0, 31.0, 50.0}}, {"factor", {1.0, 2.5, 0.7}}}}}};
    return json;
}

TEST(ModelJson, WhatHasNoNameIsSimulatedAndWrittenBackApart) {
    const Json json = with_density("density");
    const SensorModel model = model_of(json);
    ASSERT_EQ(model.effects.size(), 2U);
    EXPECT_EQ(model.effects[1].effect, "density_table");
    EXPECT_EQ(model.effects[1].axes, std::vector<std::string>{"z"});
    EXPECT_EQ(model.effects[1].table.at("factor"), (std::vector<double>{1.0, 2.5, 0.7}));
    const Json written = Json::parse(format_model(model));
    EXPECT_EQ(written["unnamed"], json["unnamed"]);
    EXPECT_EQ(written["effects"], json["effects"]);
}

TEST(ModelJson, ATableThatIsNoneIsNamed) {
    EXPECT_THAT(refusal_of(with_density("shape").dump()), HasSubstr("unnamed[0].form"));
    Json json = with_density("density");
    json["unnamed"][0]["table"]["factor"][1] = "2";
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("unnamed[0].table.factor[]"));
    json["unnamed"][0]["table"]["factor"] = 2.0;
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("unnamed[0].table.factor is not a list of numbers"));
    json["unnamed"][0]["table"] = {1.0};
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("unnamed[0].table is not an object of columns"));
    json["unnamed"] = 3;
    EXPECT_THAT(refusal_of(json.dump()), HasSubstr("unnamed is not a list"));
}

TEST(ModelJson, UnknownKeysAreKeptWhereTheyStood) {
    Json json = example();
    json["lot"] = {{"number", 7}, {"tags", {"a", nullptr, true}}};
    json["axes"]["x"]["colour"] = "red";
    json["axes"]["w"] = 1;
    json["temperature"]["hysteresis"] = 0.5;
    json["effects"][0]["note"] = "seen in June";
    json["effects"][0]["params"]["shape"] = "exponential";
    EXPECT_EQ(Json::parse(format_model(model_of(json))), with_units(json));
}

std::vector<std::string> notes_of(const Json& json);

TEST(ModelJson, ItsUnitsAreReadBackWithoutANote) {
    Json json = with_units(with_accelerometer());
    json["units"]["colour"] = "nm";
    EXPECT_EQ(Json::parse(format_model(model_of(json))), json);
    EXPECT_TRUE(notes_of(json).empty());
}

TEST(ModelJson, AnotherUnitIsToldOfAndNotWrittenBack) {
    Json json = with_units(with_accelerometer());
    const Json right = json;
    json["units"]["N"] = "rad/s/sqrt(Hz)";
    json["accelerometer"]["units"]["B"] = "m/s^2";
    EXPECT_EQ(Json::parse(format_model(model_of(json))), right);
    EXPECT_EQ(notes_of(json),
              (std::vector<std::string>{"the model says 'rad/s/sqrt(Hz)' of 'units.N': the number is read in "
                                        "dps/sqrt(Hz) all the same",
                                        "the model says 'm/s^2' of 'accelerometer.units.B': the number is "
                                        "read in g all the same"}));
    json["units"] = "SI";  // a key of one's own, before there was this one
    EXPECT_EQ(Json::parse(format_model(model_of(json))), right);
}

std::vector<std::string> notes_of(const Json& json) {
    const auto file = parse_model_file(json.dump(), "m.json", 1);
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
    return file.ok() ? file->notes : std::vector<std::string>{};
}

TEST(ModelJson, KeysOfNoEffectAreToldWithThoseThatWereMeant) {
    EXPECT_THAT(notes_of(example()), ::testing::IsEmpty());
    Json json = example();
    json["efects"] = Json::array();
    json["lot"] = 7;
    json["axes"]["x"]["k"] = 1.0;
    json["effects"][0]["parms"] = Json::object();
    const std::vector<std::string> notes = notes_of(json);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0],
              "the model has keys of no effect: 'axes.x.k' (did you mean 'K'?), "
              "'effects[0].parms' (did you mean 'params'?), 'efects' (did you mean 'effects'?)");
}

TEST(ModelJson, KeysThatDescribeItAreNotTold) {
    Json json = example();
    json["units"] = "deg/s";
    json["convention"] = "two-sided";
    json["comment"] = "the third of its lot";
    EXPECT_THAT(notes_of(json), ::testing::IsEmpty());
}

TEST(ModelJson, OfManyKeysOfNoEffectAFewAreTold) {
    Json json = example();
    for (int i = 0; i < 1000; ++i) { json["key_" + std::to_string(i)] = i; }
    for (char c = 'a'; c <= 'z'; ++c) { json[std::string("effects") + c] = 1; }
    const std::vector<std::string> notes = notes_of(json);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes[0], ::testing::EndsWith("'effectsh' (did you mean 'effects'?), ..."));
    EXPECT_LT(notes[0].size(), 1000U);
}

TEST(ModelJson, AMissingNeededKeyIsNamed) {
    for (const char* key : {"rate_hz", "axes", "schema"}) {
        Json json = example();
        json.erase(key);
        EXPECT_EQ(refusal_of(json.dump()), "model 'm.json': " + std::string(key) + " is missing");
    }
    Json json = example();
    json["axes"].erase("z");
    EXPECT_EQ(refusal_of(json.dump()), "model 'm.json': axes.z is missing");
    json = example();
    for (const char* key : {"N", "B", "K", "bias"}) { json["axes"]["y"].erase(key); }
    EXPECT_EQ(refusal_of(json.dump()),
              "model 'm.json': axes.y.N is missing, as are B, K and bias: one of them is needed");
}

// What a person writes by hand.
constexpr const char* few_numbers =
    R"({"schema": "gyrolog-model/1", "axes": {"x": {"N": 0.01}, "y": {"bias": 0.5}, "z": {"K": 1e-3}}})";

TEST(ModelJson, AFewNumbersAreAModel) {
    const auto file = parse_model_file(few_numbers, "m.json", 1);
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_DOUBLE_EQ(file->model.axes[0].noise.N_rad_per_sqrt_s, 0.01 * rad_per_deg);
    EXPECT_EQ(file->model.axes[0].noise.B_rad_per_s, 0.0);
    EXPECT_DOUBLE_EQ(file->model.axes[1].bias_rad_s, 0.5 * rad_per_deg);
    EXPECT_EQ(file->model.M, identity_matrix);
    EXPECT_EQ(file->model.saturation_rad_s, no_range_rad_s);
    EXPECT_THAT(file->notes, testing::ElementsAre("the model does not state latency_s, timestamp_jitter_s, "
                                                  "ref_noise_dps, acc_noise_g, temp_noise_C, B, K, bias, N: "
                                                  "taken as 0, exactly"));
    EXPECT_TRUE(parse_model_file(example().dump(), "m.json", 1)->notes.empty());
}

Recording of_rates_dps(std::vector<double> numbers, double dps_per_number) {
    Recording recording;
    recording.rate_hz = 62.5;
    recording.columns.push_back(
        {"gx", "rad/s", std::move(numbers), dps_per_number * rad_per_deg, 0.0, "dps"});
    recording.segments.push_back({0, recording.rows(), 0});
    return recording;
}

TEST(ModelJson, ARecordingTellsWhatTheModelDoesNotState) {
    auto file = parse_model_file(few_numbers, "m.json", 1);
    ASSERT_TRUE(file.ok());
    const Recording on_grid = of_rates_dps({1.0, 1.5, -2.5, 0.5, 1.0, 1.5, 0.5, -2.5, 1.0, 0.5}, 0.02);
    complete_from(on_grid, *file);
    EXPECT_EQ(file->model.rate_hz, 62.5);
    EXPECT_NEAR(file->model.lsb_rad_s, 0.01 * rad_per_deg, 1e-12);
    EXPECT_NEAR(file->model.full_scale_rad_s, 327.68 * rad_per_deg, 1e-9);
    EXPECT_NEAR(file->model.saturation_rad_s, 327.67 * rad_per_deg, 1e-9);
    EXPECT_EQ(
        file->notes.back(),
        "the model does not state rate_hz (62.5), lsb_dps (0.01), full_scale_dps (327.68): taken from the "
        "recording");
    // Once is enough.
    const std::size_t notes = file->notes.size();
    complete_from(on_grid, *file);
    EXPECT_EQ(file->notes.size(), notes);
}

// Nobody knows what such a count is in deg/s.
TEST(ModelJson, CountsWithoutAScaleTellTheRateOnly) {
    auto file = parse_model_file(few_numbers, "m.json", 1);
    ASSERT_TRUE(file.ok());
    Recording counts = of_rates_dps({1.0, 1.5, -2.5, 0.5, 1.0, 1.5, 0.5, -2.5}, 1.0);
    counts.columns[0].unit = "lsb";
    complete_from(counts, *file);
    EXPECT_EQ(file->model.rate_hz, 62.5);
    EXPECT_EQ(file->model.lsb_rad_s, 0.0);
    EXPECT_EQ(file->model.full_scale_rad_s, no_range_rad_s);
}

TEST(ModelJson, WhatTheModelStatesARecordingDoesNotChange) {
    auto file = parse_model_file(example().dump(), "m.json", 1);
    ASSERT_TRUE(file.ok());
    complete_from(of_rates_dps({1.0, 1.5, 0.5, -2.5, 1.5, 1.0}, 0.02), *file);
    EXPECT_EQ(Json::parse(format_model(file->model)), with_units(example()));
    EXPECT_TRUE(file->notes.empty());
}

// Printed decimals that 16 bits do not reach are no converter's codes.
TEST(ModelJson, TheRangeHoldsWhatWasRecorded) {
    auto file = parse_model_file(few_numbers, "m.json", 1);
    ASSERT_TRUE(file.ok());
    complete_from(of_rates_dps({1.0, 2.0, 400000.0, -3.0, 1.0, 2.0, -3.0, 400000.0}, 1e-3), *file);
    EXPECT_NEAR(file->model.full_scale_rad_s, 500.0 * rad_per_deg, 1e-9);
}

TEST(ModelJson, OptionalKeysMayBeMissing) {
    Json json = example();
    for (const char* key : {"orientation", "misalignment_percent", "temperature"}) { json.erase(key); }
    for (const char* key : {"Q", "R", "sd"}) { json["axes"]["x"].erase(key); }
    const SensorModel model = model_of(json);
    EXPECT_EQ(model.orientation, std::nullopt);
    EXPECT_EQ(model.axes[0].noise.Q_rad, 0.0);
    EXPECT_EQ(Json::parse(format_model(model)), with_units(json));
}

TEST(ModelJson, AWrongTypeOrAnImpossibleNumberIsNamed) {
    const std::vector<std::pair<std::string, Json>> wrong = {{"/rate_hz", "fast"},
                                                             {"/rate_hz", 0},
                                                             {"/rate_hz", nullptr},
                                                             {"/lsb_dps", -1},
                                                             {"/axes", 1},
                                                             {"/axes/x", Json::array()},
                                                             {"/axes/x/N", "0.1"},
                                                             {"/axes/x/N", -0.1},
                                                             {"/M", 1},
                                                             {"/M/1", 1},
                                                             {"/M/1/2", "a"},
                                                             {"/sd_rel", 1},
                                                             {"/sd_rel/N", "a"},
                                                             {"/effects", 1},
                                                             {"/effects/0", 1},
                                                             {"/effects/0/effect", 1},
                                                             {"/effects/0/axes", "x"},
                                                             {"/orientation", 1},
                                                             {"/misalignment_percent", Json::array({1, 2})},
                                                             {"/temperature", 1},
                                                             {"/noise_type", "sideways"}};
    for (const auto& [place, value] : wrong) {
        Json json = example();
        json[Json::json_pointer(place)] = value;
        const std::string refusal = refusal_of(json.dump());
        std::string key = place.substr(1, place.find('/', 1) - 1);
        EXPECT_NE(refusal.find(key), std::string::npos) << place << ": " << refusal;
    }
}

TEST(ModelJson, ANumberThatIsNotFiniteIsNamedHoweverItIsWritten) {
    for (const char* number : {"NaN", "Infinity", "-Infinity", "1e999"}) {
        std::string text = full_example;
        text.replace(text.find("0.006"), 5, number);
        EXPECT_EQ(refusal_of(text), "model 'm.json': axes.y.N is not a finite number");
    }
    std::string text = full_example;
    text.replace(text.find("\"M\""), 0, "\"unknown\": NaN, ");
    EXPECT_EQ(refusal_of(text), "model 'm.json': holds a number that is not finite");
}

TEST(ModelJson, WhatIsNoModelIsRefused) {
    EXPECT_EQ(refusal_of(""), "model 'm.json': no JSON: the file is empty");
    EXPECT_EQ(refusal_of("[1, 2]"), "model 'm.json': not a JSON object");
    EXPECT_EQ(refusal_of("{\n  \"schema\": \"gyrolog-model/1\",\n  // the rate\n}"),
              "model 'm.json': no JSON: line 3, column 3: invalid literal; last read: "
              "'\"gyrolog-model/1\",<U+000A> "
              " /'; expected string literal");
    EXPECT_THAT(refusal_of(std::string(full_example, 200)),
                testing::HasSubstr("line 5, column 63: invalid string: missing closing quote"));
    EXPECT_EQ(refusal_of("\xFF\xFE{"), "model 'm.json': no JSON: the text is UTF-16: save it as UTF-8");
    EXPECT_LT(refusal_of("{\"" + std::string(1'000'000, 'a') + "\"; 1}").size(), 300U);
    EXPECT_EQ(refusal_of(std::string(100'000, '[')), "model 'm.json': nested more than 32 deep");
    Json json = example();
    json["schema"] = "gyrolog-model/2";
    EXPECT_EQ(refusal_of(json.dump()),
              "model 'm.json': schema is 'gyrolog-model/2', not 'gyrolog-model/1' (or 'gyrolog-datasheet/1', "
              "'gyrolog-population/1', 'gyrolog-gyroparams/1')");
}

TEST(ModelJson, AOneSidedDensityIsTwiceTheTwoSidedOne) {
    Json json = example();
    json["noise_type"] = "one_sided";
    const SensorModel one_sided = model_of(json);
    json["noise_type"] = "two_sided";
    const SensorModel two_sided = model_of(json);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        NoiseCoefficients given = two_sided.axes[axis].noise;
        NoiseCoefficients taken = one_sided.axes[axis].noise;
        given.Q_rad = taken.Q_rad = 0.0;
        given.R_rad_per_s2 = taken.R_rad_per_s2 = 0.0;
        for (const double f_hz : {0.001, 0.1, 10.0}) {
            EXPECT_NEAR(given.psd(f_hz) / (2.0 * taken.psd(f_hz)), 1.0, 1e-14);
        }
    }
}

TEST(ModelJson, FilesAreReadAndWritten) {
    const std::string path = testing::TempDir() + "model_json_test.json";
    ASSERT_TRUE(write_model(model_of(example()), path).ok());
    const auto model = read_model(path);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ(Json::parse(format_model(*model)), with_units(example()));
    EXPECT_EQ(std::remove(path.c_str()), 0);
    const auto missing = read_model(path);
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    EXPECT_NE(missing.error().message.find(path), std::string::npos);
}

TEST(ModelJson, TheTypicalSensorSurvivesTheFile) {
    const SensorModel typical = typical_mpu9250();
    const SensorModel back = model_of(Json::parse(format_model(typical)));
    EXPECT_EQ(back.lsb_rad_s, typical.lsb_rad_s);
    EXPECT_EQ(back.saturation_rad_s, typical.saturation_rad_s);
    EXPECT_EQ(back.acc_noise_m_s2, typical.acc_noise_m_s2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(back.axes[axis].noise.N_rad_per_sqrt_s, typical.axes[axis].noise.N_rad_per_sqrt_s);
        EXPECT_EQ(back.axes[axis].bias_rad_s, typical.axes[axis].bias_rad_s);
    }
}

}  // namespace
}  // namespace gyrolog
