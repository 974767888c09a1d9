#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "host/formats/effect_catalogue.hpp"
#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

std::string temporary(const char* name) { return testing::TempDir() + "recording_csv_write_" + name; }

std::string contents(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

CsvWriteOptions resolved(std::vector<std::string> columns = {"gx", "gy", "gz", "temp"}) {
    return {.rate_unit = {}, .resolved = std::move(columns)};
}

SensorModel lossy_model() {
    SensorModel model = typical_mpu9250();
    model.effects = {{.effect = "dropped", .axes = {}, .params = {{"per_hour", 500.0}}, .carried_json = {}}};
    return model;
}

TEST(SimulatedText, ReadBackHasTheSameCountsStampsAndGrid) {
    const SensorModel model = lossy_model();
    const Recording made = simulate_recording(model, {.samples = 50'000, .seed = 2});
    const std::string path = temporary("counts.csv.gz");
    ASSERT_TRUE(write_recording_csv(made, path, resolved()).ok());
    const auto read = read_recording_csv(path);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->t_s, made.t_s);
    EXPECT_EQ(read->rate_hz, made.rate_hz);
    EXPECT_EQ(read->stamp_jitter_s, made.stamp_jitter_s);
    ASSERT_EQ(read->segments.size(), made.segments.size());
    EXPECT_GT(made.segments.size(), 20U);
    for (std::size_t s = 0; s < made.segments.size(); ++s) {
        EXPECT_EQ(read->segments[s].first_index, made.segments[s].first_index);
        EXPECT_EQ(read->segments[s].count, made.segments[s].count);
    }
    for (const char* name : {"gx", "gy", "gz"}) {
        const auto& counts = std::get<std::vector<std::int16_t>>(made.find(name)->data);
        for (std::size_t row = 0; row < made.rows(); ++row) {
            const double in_counts = read->find(name)->value(row) / model.lsb_rad_s;
            ASSERT_EQ(std::lround(in_counts), counts[row]);
            ASSERT_NEAR(in_counts, counts[row], 1e-3);
        }
    }
    std::filesystem::remove(path);
}

TEST(SimulatedText, WithoutAnLsbKeepsNineDigits) {
    SensorModel model = typical_mpu9250();
    model.lsb_rad_s = 0.0;
    const Recording made = simulate_recording(model, {.samples = 3000, .seed = 2});
    const std::string path = temporary("reals.csv");
    ASSERT_TRUE(write_recording_csv(made, path, resolved()).ok());
    const auto read = read_recording_csv(path);
    ASSERT_TRUE(read.ok());
    for (std::size_t row = 0; row < made.rows(); ++row) {
        const double truth = made.find("gy")->value(row);
        ASSERT_NEAR(read->find("gy")->value(row), truth, 1e-8 * std::fabs(truth));
    }
    std::filesystem::remove(path);
}

Recording small() {
    Recording recording;
    recording.rate_hz = 10.0;
    recording.segments = {{0, 4, 0}};
    recording.t_s = {-2e-6, 0.1, 0.2, 1234567.000000001};
    recording.columns = {
        {"gx", "rad/s", std::vector<std::int16_t>{-1, 0, 1, -32768}, 0.0152671 * rad_per_deg, 0.0, {}},
        {"temp", "degC", std::vector<double>{25.123456, -0.00001, 25.0, 99.99996}, 1.0, 0.0, {}},
        {"ref_x", "rad/s", std::vector<double>{0.1, 1e-9, -2.5, 1e12}, 1.0, 0.0, "rad_s"}};
    return recording;
}

TEST(SimulatedText, HasAsManyDigitsAsAStepResolvesAndNoExponentInStamps) {
    const std::string path = temporary("small.csv");
    ASSERT_TRUE(write_recording_csv(small(), path, resolved({"gx", "temp", "ref_x"})).ok());
    EXPECT_EQ(contents(path),
              "t_s,gx_dps,temp_C,ref_x_rad_s\n"
              "-0.000002,-0.01527,25.1235,0.1\n"
              "0.1,0.00000,0.0000,1e-09\n"
              "0.2,0.01527,25.0000,-2.5\n"
              "1234567.000000001,-500.27233,100.0000,1e+12\n");
    std::filesystem::remove(path);
}

TEST(SimulatedText, WhatWasTakenOverIsExact) {
    const std::string path = temporary("exact.csv");
    Recording recording = small();
    recording.columns[2].source_unit.clear();
    ASSERT_TRUE(write_recording_csv(recording, path, resolved({"gx"})).ok());
    const auto read = read_recording_csv(path, {.rate_hz = 10.0});
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->find("temp")->data, recording.columns[1].data);
    for (std::size_t row = 0; row < 4; ++row) {
        EXPECT_DOUBLE_EQ(read->find("ref_x")->value(row), recording.columns[2].value(row));
    }
    std::filesystem::remove(path);
}

TEST(SimulatedText, OfPiecesIsThatOfTheWhole) {
    const SensorModel model = lossy_model();
    const SimulationRequest request = {.samples = 20'000, .seed = 6};
    const std::string whole_path = temporary("whole.csv");
    const std::string pieces_path = temporary("pieces.csv");
    ASSERT_TRUE(write_recording_csv(simulate_recording(model, request), whole_path, resolved()).ok());
    auto writer = RecordingCsvWriter::create(pieces_path, resolved());
    ASSERT_TRUE(writer.ok());
    RecordingSimulator simulator(model, request);
    Recording piece;
    while (simulator.next(piece)) { ASSERT_TRUE(writer->append(piece).ok()); }
    EXPECT_FALSE(std::filesystem::exists(pieces_path));  // not before it is whole
    ASSERT_TRUE(writer->close().ok());
    EXPECT_EQ(contents(pieces_path), contents(whole_path));
    std::filesystem::remove(whole_path);
    std::filesystem::remove(pieces_path);
}

TEST(SimulatedText, ThatIsNotClosedLeavesWhatWasThere) {
    const std::string path = temporary("kept.csv");
    std::ofstream(path) << "precious";
    {
        auto writer = RecordingCsvWriter::create(path, resolved());
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(writer->append(small()).ok());
    }
    EXPECT_EQ(contents(path), "precious");
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    std::filesystem::remove(path);
}

// Ten samples, two lost, three that the user wanted away, ten samples, four lost, five samples.
Recording stopped_once() {
    Recording recording;
    recording.rate_hz = 8.0;
    recording.columns = {{"gx", "rad/s", std::vector<double>(25, 1.0), rad_per_deg, 0.0, "dps"}};
    recording.segments = {{0, 10, 0}, {10, 10, 15}, {20, 5, 29}};
    recording.dropouts = {
        {10 / 8.0, 2, "link"}, {12 / 8.0, 3, std::string(stopped_cause)}, {25 / 8.0, 4, "link"}};
    return recording;
}

TEST(RecordingText, SaysWhichHoleWasAStop) {
    const std::string path = temporary("stopped.csv");
    ASSERT_TRUE(write_recording_csv(stopped_once(), path).ok());
    const auto read = read_recording_csv(path);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(read->warnings.empty());
    EXPECT_EQ(read->columns.size(), 1U);
    EXPECT_EQ(read->stops().events, 1U);
    EXPECT_EQ(read->stops().instants, 3);
    EXPECT_NEAR(read->stops().s, 3 / 8.0, 1e-9);
    ASSERT_EQ(read->dropouts.size(), 3U);
    const Recording told = stopped_once();
    for (std::size_t i = 0; i < told.dropouts.size(); ++i) {
        EXPECT_NEAR(read->dropouts[i].at_s, told.dropouts[i].at_s, 1e-9) << i;
        EXPECT_EQ(read->dropouts[i].samples, told.dropouts[i].samples) << i;
        EXPECT_EQ(read->dropouts[i].cause == stopped_cause, i == 1) << i;
    }
    // Who does not know the column has the samples and holes all the same.
    std::string text = contents(path);
    text.replace(text.find("stopped_s"), 9, "something");
    const auto unknowing = parse_recording_csv(text, "text");
    ASSERT_TRUE(unknowing.ok());
    EXPECT_EQ(unknowing->missing_samples(), read->missing_samples());
    EXPECT_EQ(unknowing->warnings.size(), 1U);
    std::filesystem::remove(path);
}

TEST(RecordingText, HasNoColumnOfStopsWithoutOne) {
    Recording recording = stopped_once();
    recording.dropouts[1].cause = "link";
    const std::string path = temporary("lost.csv");
    ASSERT_TRUE(write_recording_csv(recording, path).ok());
    EXPECT_EQ(contents(path).substr(0, contents(path).find('\n')), "t_s,gx_dps");
    std::filesystem::remove(path);
}

TEST(RecordingText, TakesNoStopBeyondItsHole) {
    const auto read = parse_recording_csv(
        "t_s,gx_dps,stopped_s\n0,1,5\n1,1,\n2,1,7\n5,1,1e300\n6,1,nan\n7,1,0\n8,1,0\n9,1,0\n10,1,0\n11,1,"
        "0\n12,1,0\n",
        "text");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->stops().events, 1U);
    EXPECT_EQ(read->stops().instants, 2);
    EXPECT_EQ(read->missing_samples(), 2);
}

TEST(EffectCatalogue, TellsEveryEffectWithItsFormulaAndParameters) {
    const std::string text = effect_catalogue_text();
    const auto json = effect_catalogue_json();
    EXPECT_EQ(json["schema"], "gyrolog-effects/1");
    EXPECT_GE(json["effects"].size(), 30U);
    for (const auto& effect : json["effects"]) {
        const auto name = effect["effect"].get<std::string>();
        EXPECT_NE(text.find(std::string(1, '\n').append(name).append("\n")), std::string::npos) << name;
        EXPECT_FALSE(effect["model"].get<std::string>().empty());
        for (const auto& param : effect["params"]) {
            EXPECT_FALSE(param["meaning"].get<std::string>().empty()) << effect["effect"];
            EXPECT_NE(text.find(param["name"].get<std::string>()), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace gyrolog
