// Data sheets and gyroparams as models.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "host/formats/export_source.hpp"
#include "host/formats/gyroparams_script.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

using Json = nlohmann::json;

// PS-MPU-9250A-01 rev. 1.1, table 1.
Json mpu9250() {
    return Json::parse(R"({
        "schema": "gyrolog-datasheet/1", "sensor": "MPU-9250", "source": "PS-MPU-9250A-01 rev. 1.1, table 1",
        "rate_hz": 1000, "full_scale_dps": 500, "sensitivity_lsb_per_dps": 65.5,
        "noise_type": "one_sided", "noise_density_dps_per_sqrt_hz": 0.01,
        "zero_rate_output_dps": 5, "zero_rate_output_over_temperature_dps": 30,
        "scale_tolerance_percent": 3, "scale_over_temperature_percent": 4, "temperature_range_C": [-40, 85],
        "cross_axis_percent": 2, "nonlinearity_percent": 0.1, "rate_tolerance_percent": 1})");
}

Json published_block() {
    return Json::parse(R"({
        "schema": "gyrolog-gyroparams/1", "SampleRate": 100, "MeasurementRange": 8.5, "Resolution": 2.5e-4,
        "ConstantBias": [0.005, -0.002, 0.001], "AxesMisalignment": [0.5, 1.5, -0.25],
        "NoiseType": "single-sided", "NoiseDensity": [1e-4, 2e-4, 3e-4], "BiasInstability": 3e-5,
        "RandomWalk": [1e-6, 2e-6, 3e-6], "TemperatureBias": [1e-3, 2e-3, 3e-3],
        "TemperatureScaleFactor": 0.04, "AccelerationBias": [1e-4, 0, -2e-4]})");
}

SensorModel model_of(const Json& json, std::uint64_t seed = 1) {
    auto model = parse_model(json.dump(), "s.json", seed);
    EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
    return model.ok() ? *model : SensorModel{};
}

std::string refusal_of(const Json& json) {
    const auto model = parse_model(json.dump(), "s.json");
    return model.ok() ? "accepted" : model.error().message;
}

TEST(DatasheetJson, AOneSidedDensityIsSqrt2TimesTheModelsN) {
    EXPECT_DOUBLE_EQ(model_of(mpu9250()).axes[0].noise.N_rad_per_sqrt_s, 0.01 / std::sqrt(2.0) * rad_per_deg);
    Json two_sided = mpu9250();
    two_sided["noise_type"] = "two_sided";
    EXPECT_DOUBLE_EQ(model_of(two_sided).axes[0].noise.N_rad_per_sqrt_s, 0.01 * rad_per_deg);
}

TEST(DatasheetJson, TheSimulatedSamplesHaveTheRootMeanSquareThatAOneSidedDensityPromises) {
    Json sheet = mpu9250();
    sheet.erase("sensitivity_lsb_per_dps");
    SensorSimulator simulator(model_of(sheet), 1000.0, 1);
    double sum = 0.0;
    double squares = 0.0;
    constexpr int blocks = 100;
    for (int i = 0; i < blocks; ++i) {
        for (const double rate : simulator.next_block().rate_rad_s[1]) {
            sum += rate;
            squares += rate * rate;
        }
    }
    constexpr double count = blocks * static_cast<double>(block_samples);
    const double rms_dps = std::sqrt(squares / count - sum / count * sum / count) * deg_per_rad;
    // White to half the rate: 0.01 dps/sqrt(Hz) over 500 Hz. The temperature's slow wander adds a little.
    EXPECT_NEAR(rms_dps / (0.01 * std::sqrt(500.0)), 1.0, 4.0 / std::sqrt(2.0 * count) + 0.01);
}

TEST(DatasheetJson, ARootMeanSquareOverItsBandwidthGivesTheSameNoiseWhateverTheSides) {
    for (const char* type : {"one_sided", "two_sided"}) {
        Json sheet = mpu9250();
        sheet.erase("noise_density_dps_per_sqrt_hz");
        sheet["noise_type"] = type;
        sheet["total_rms_noise_dps"] = 0.1;
        sheet["noise_bandwidth_hz"] = 100.0;
        EXPECT_DOUBLE_EQ(model_of(sheet).axes[2].noise.N_rad_per_sqrt_s, 0.01 / std::sqrt(2.0) * rad_per_deg);
    }
}

TEST(DatasheetJson, InstabilityIsTheLowestAllanDeviationAndTheWalkFollowsTheSides) {
    Json sheet = mpu9250();
    sheet["bias_instability_deg_per_h"] = 10.0;
    sheet["rate_random_walk_dps_sqrt_hz"] = 1e-4;
    const NoiseCoefficients noise = model_of(sheet).axes[0].noise;
    EXPECT_NEAR(noise.B_rad_per_s * 0.664282, 10.0 / 3600.0 * rad_per_deg, 1e-10);
    EXPECT_DOUBLE_EQ(noise.K_rad_per_s_sqrt_s, 1e-4 / std::sqrt(2.0) * rad_per_deg);
}

TEST(DatasheetJson, WithoutANoiseTypeItIsRefused) {
    Json sheet = mpu9250();
    sheet.erase("noise_type");
    EXPECT_EQ(refusal_of(sheet), "model 's.json': noise_type is missing");
    sheet["noise_type"] = "single";
    EXPECT_EQ(refusal_of(sheet), "model 's.json': noise_type is neither one_sided nor two_sided");
}

TEST(DatasheetJson, WhatIsMissingOrWrongIsNamed) {
    const auto without = [](const char* key) {
        Json sheet = mpu9250();
        sheet.erase(key);
        return refusal_of(sheet);
    };
    EXPECT_EQ(without("rate_hz"), "model 's.json': rate_hz is missing");
    EXPECT_EQ(without("noise_density_dps_per_sqrt_hz"),
              "model 's.json': noise_density_dps_per_sqrt_hz is missing, and so is total_rms_noise_dps");
    EXPECT_EQ(without("temperature_range_C"),
              "model 's.json': temperature_range_C is missing beside a tolerance over temperature");
    const auto with = [](const char* key, const Json& value) {
        Json sheet = mpu9250();
        sheet[key] = value;
        return refusal_of(sheet);
    };
    EXPECT_EQ(with("scale_tolerence_percent", 3),
              "model 's.json': scale_tolerence_percent is no key of this schema");
    EXPECT_EQ(with("cross_axis_percent", -2), "model 's.json': cross_axis_percent is negative");
    EXPECT_EQ(with("temperature_range_C", {85, -40}), "model 's.json': temperature_range_C does not ascend");
    EXPECT_EQ(with("total_rms_noise_dps", 0.1),
              "model 's.json': noise_bandwidth_hz is missing beside total_rms_noise_dps");
    EXPECT_EQ(with("sensitivity_lsb_per_dps", 1e-320),
              "model 's.json': holds a number too large or too small to work with");
}

TEST(DatasheetJson, TheDrawnUnitWrittenAsAModelIsThatUnit) {
    const SensorModel unit = model_of(mpu9250(), 7);
    const std::string written = format_model(unit);
    const auto back = parse_model(written, "unit.json", 99);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(format_model(*back), written);
    EXPECT_EQ(back->M, unit.M);
    EXPECT_NE(model_of(mpu9250(), 8).M, unit.M);
    EXPECT_EQ(simulation_refusal(unit), std::nullopt);
}

TEST(DatasheetJson, SaysThatAUnitWasDrawnAndWhatTheSheetDoesNotGive) {
    const auto file = parse_model_file(mpu9250().dump(), "s.json", 7);
    ASSERT_TRUE(file.ok());
    ASSERT_EQ(file->notes.size(), 2U);
    EXPECT_EQ(file->notes[0], "a unit drawn from the data sheet of MPU-9250 by seed 7");
    EXPECT_EQ(file->notes[1],
              "not in the data sheet, so not simulated: bias instability, rate random walk, sensitivity to "
              "specific "
              "force, noise of the thermometer");
}

// The example stands in the header for people; it must be what the program reads.
TEST(DatasheetJson, TheExampleInTheHeaderIsReadAndIsTheMpu9250) {
    const char* source = std::getenv("GYROLOG_SOURCE_DIR");
    ASSERT_NE(source, nullptr);
    std::ifstream header(std::string(source) + "/host/formats/datasheet_json.hpp");
    std::string line;
    std::string example;
    while (std::getline(header, line)) {
        if (line == "//   {" || !example.empty()) { example += line.substr(2) + "\n"; }
        if (line == "//   }") { break; }
    }
    EXPECT_EQ(Json::parse(example), mpu9250());
}

TEST(GyroparamsJson, EveryPropertyActsInItsUnit) {
    const SensorModel model = model_of(published_block());
    EXPECT_EQ(model.rate_hz, 100.0);
    EXPECT_EQ(model.full_scale_rad_s, 8.5);
    EXPECT_EQ(model.saturation_rad_s, 8.5);
    EXPECT_EQ(model.lsb_rad_s, 2.5e-4);
    EXPECT_EQ(model.axes[1].bias_rad_s, -0.002);
    EXPECT_DOUBLE_EQ((*model.misalignment)[1], 0.015);
    EXPECT_EQ(model.axes[2].noise.N_rad_per_sqrt_s, 3e-4);
    EXPECT_EQ(model.axes[2].noise.B_rad_per_s, 3e-5);
    EXPECT_EQ(model.axes[0].noise.K_rad_per_s_sqrt_s, 1e-6);
    EXPECT_EQ(model.temperature->reference_C, 25.0);
    EXPECT_EQ(model.temperature->bias_rad_s_per_C[1], 2e-3);
    EXPECT_DOUBLE_EQ(model.temperature->scale_per_C[0], 4e-4);
    ASSERT_EQ(model.effects.size(), 2U);
    EXPECT_EQ(model.effects[1].effect, "g_sensitivity");
    EXPECT_EQ(model.effects[1].axes, std::vector<std::string>{"z"});
    EXPECT_DOUBLE_EQ(model.effects[1].params.at("z_dps_per_g"), -2e-4 * standard_gravity_m_s2 * deg_per_rad);
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
}

// imuSensor's generated code: white noise of deviation NoiseDensity sqrt(w) and steps of the random walk of
// RandomWalk / sqrt(w), w the rate for "single-sided" and half of it for "double-sided".
TEST(GyroparamsJson, NoiseIsAsLargeAsImuSensorMakesItWithEitherType) {
    Json json = published_block();
    for (const double sides : {1.0, 2.0}) {
        json["NoiseType"] = sides == 1.0 ? "single-sided" : "double-sided";
        const SensorModel model = model_of(json);
        const double w = model.rate_hz / sides;
        const NoiseCoefficients& noise = model.axes[1].noise;
        EXPECT_DOUBLE_EQ(noise.N_rad_per_sqrt_s * std::sqrt(model.rate_hz), 2e-4 * std::sqrt(w));
        EXPECT_DOUBLE_EQ(noise.K_rad_per_s_sqrt_s / std::sqrt(model.rate_hz), 2e-6 / std::sqrt(w));
        EXPECT_EQ(noise.B_rad_per_s, 3e-5);
    }
    json.erase("NoiseType");
    EXPECT_EQ(refusal_of(json), "model 's.json': NoiseType is missing");
    for (const char* key : {"NoiseDensity", "BiasInstability", "RandomWalk"}) { json.erase(key); }
    EXPECT_EQ(refusal_of(json), "accepted");
}

TEST(GyroparamsJson, AFullMisalignmentMatrixIsTakenAsItIs) {
    Json json = published_block();
    json["AxesMisalignment"] = {{100.0, 1.0, 2.0}, {3.0, 99.0, 4.0}, {5.0, 6.0, 101.0}};
    const SensorModel model = model_of(json);
    EXPECT_EQ(model.misalignment, std::nullopt);
    EXPECT_DOUBLE_EQ(model.M[0][2], 0.02);
    EXPECT_DOUBLE_EQ(model.M[1][1], 0.99);
    EXPECT_DOUBLE_EQ(model.M[2][0], 0.05);
}

TEST(GyroparamsJson, WhatIsWrongIsNamed) {
    const auto with = [](const char* key, const Json& value) {
        Json json = published_block();
        json[key] = value;
        return refusal_of(json);
    };
    EXPECT_EQ(with("NoiseDensety", 1), "model 's.json': NoiseDensety is no key of this schema");
    EXPECT_EQ(with("NoiseDensity", {1, -1, 1}), "model 's.json': NoiseDensity is negative");
    EXPECT_EQ(with("ConstantBias", {1, 2}), "model 's.json': ConstantBias is not a list of 3 numbers");
    EXPECT_EQ(with("NoiseType", "two_sided"),
              "model 's.json': NoiseType is neither single-sided nor double-sided");
    EXPECT_EQ(with("SampleRate", 0), "model 's.json': SampleRate is not above zero");
    EXPECT_EQ(with("BiasInstabilityCoefficients", Json::object()), "accepted");
}

// What `export` writes for MATLAB, read back by its property names.
TEST(GyroparamsJson, AgreesWithTheExportedScript) {
    const SensorModel model = model_of(published_block());
    std::istringstream script(gyroparams_script(export_source(model, "m")));
    Json json = {{"schema", "gyrolog-gyroparams/1"}, {"SampleRate", model.rate_hz}};
    const std::regex property(R"(\s*params\.(\w+) = ([^;]+);.*)");
    std::string line;
    while (std::getline(script, line) &&
           !line.starts_with("else")) {  // beyond: for releases without NoiseType
        std::smatch found;
        if (!std::regex_match(line, found, property)) { continue; }
        std::string value = found[2];
        std::ranges::replace(value, '\'', '"');
        if (value.front() == '[') { std::ranges::replace(value, ' ', ','); }
        json[found[1].str()] = Json::parse(value);
    }
    EXPECT_GE(json.size(), 10U);
    const SensorModel back = model_of(json);
    EXPECT_DOUBLE_EQ(back.full_scale_rad_s, model.full_scale_rad_s);
    EXPECT_DOUBLE_EQ(back.lsb_rad_s, model.lsb_rad_s);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const AxisModel& read = back.axes[axis];
        const AxisModel& written = model.axes[axis];
        EXPECT_DOUBLE_EQ(read.bias_rad_s, written.bias_rad_s);
        EXPECT_DOUBLE_EQ(read.noise.N_rad_per_sqrt_s, written.noise.N_rad_per_sqrt_s);
        EXPECT_DOUBLE_EQ(read.noise.B_rad_per_s, written.noise.B_rad_per_s);
        EXPECT_DOUBLE_EQ(read.noise.K_rad_per_s_sqrt_s, written.noise.K_rad_per_s_sqrt_s);
        EXPECT_DOUBLE_EQ(back.temperature->bias_rad_s_per_C[axis], model.temperature->bias_rad_s_per_C[axis]);
        EXPECT_DOUBLE_EQ(back.temperature->scale_per_C[axis], model.temperature->scale_per_C[axis]);
    }
}

}  // namespace
}  // namespace gyrolog
