#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/app/command_line.hpp"
#include "host/app/stage_clock.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;

// A recording analysed twice, which takes a second each time.
class AnalyzeCommand : public ::testing::Test {
protected:
    struct Answer {
        json report;  // on standard output
        std::string err;
    };

    static void SetUpTestSuite() {
        const TemporaryFolder folder;
        const std::string path = folder.path("run.pcapng");
        std::ostringstream quiet;
        ASSERT_EQ(
            run_command_line({"capture", "--device", "sim:rate=100,seed=7", "--samples", "2000", "-o", path},
                             {quiet, quiet}),
            ExitCode::ok)
            << quiet.str();
        usual_ = analyze({path});
        every_m_ = analyze({path, "--m", "all", "--timing", "--sensor", "gyro"});
        gyro_ = analyze({path, "--sensor", "gyro"});
    }

    static Answer analyze(std::vector<std::string> arguments) {
        std::ostringstream out;
        std::ostringstream err;
        arguments.insert(arguments.begin(), {"analyze", "--json", "-"});
        EXPECT_EQ(run_command_line(std::move(arguments), {out, err}), ExitCode::ok) << err.str();
        return {json::parse(out.str(), nullptr, false), err.str()};
    }

    static Answer usual_;
    static Answer every_m_;
    static Answer gyro_;
};

AnalyzeCommand::Answer AnalyzeCommand::usual_;
AnalyzeCommand::Answer AnalyzeCommand::every_m_;
AnalyzeCommand::Answer AnalyzeCommand::gyro_;

TEST_F(AnalyzeCommand, AtEveryFactorGivesEveryPointAndTheSameOnesAsAtTheUsualFactors) {
    const json& every = every_m_.report["axes"]["x"]["allan"];
    const json& usual = usual_.report["axes"]["x"]["allan"];
    ASSERT_EQ(every.size(), 1000U);
    ASSERT_GT(usual.size(), 50U);
    for (const json& point : usual) {
        const auto m = point["m"].get<std::size_t>();
        const json& same = every.at(m - 1);
        EXPECT_EQ(same["m"], m);
        EXPECT_EQ(same["value"], point["value"]);
        // Where there are so many points, intervals are interpolated.
        EXPECT_NEAR(same["edf"].get<double>() / point["edf"].get<double>(), 1.0, 0.02) << "m = " << m;
    }
}

TEST_F(AnalyzeCommand, FactorsThatAreShownDoNotChangeTheCoefficients) {
    const json& coefficients = usual_.report["axes"]["x"]["coefficients"];
    ASSERT_TRUE(coefficients.contains("N"));
    EXPECT_EQ(every_m_.report["axes"]["x"]["coefficients"], coefficients);
}

TEST_F(AnalyzeCommand, TimingNamesEveryStageOnStandardErrorOnRequest) {
    for (const char* stage :
         {"read", "decode", "integrate", "deviation", "intervals", "fit", "json", "together"}) {
        EXPECT_NE(every_m_.err.find(std::string("\n") + stage), std::string::npos) << stage << every_m_.err;
    }
    EXPECT_EQ(usual_.err.find("together"), std::string::npos) << usual_.err;
}

std::string write_text_recording(const TemporaryFolder& folder, const std::string& gyro_columns) {
    std::string path = folder.path("run.csv");
    std::ofstream text(path);
    text << "t_s," << gyro_columns << '\n';
    unsigned state = 1;
    for (int i = 0; i < 500; ++i) {
        state = state * 1664525U + 1013904223U;
        text << i / 100.0 << ',' << (state >> 16) % 1000 << ',' << (state >> 20) % 1000 << '\n';
    }
    return path;
}

struct CommandResult {
    ExitCode exit_code = ExitCode::ok;
    std::string out;
    std::string err;
};

CommandResult run(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const ExitCode exit_code = run_command_line(std::move(arguments), {out, err});
    return {exit_code, out.str(), err.str()};
}

TEST(AnalyzeFiles, AModelOfAnArrayOfGyrosIsRefused) {
    const TemporaryFolder folder;
    const std::string model = folder.path("model.json");
    const CommandResult result =
        run({"analyze", write_text_recording(folder, "gx2_dps,gx3_dps"), "--model", model});
    EXPECT_EQ(result.exit_code, ExitCode::usage);
    EXPECT_NE(result.err.find("a model is of one sensor with axes x, y and z"), std::string::npos)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(model));
}

// A gyro and an accelerometer of a sensor at rest.
std::string write_imu_recording(const TemporaryFolder& folder) {
    std::string path = folder.path("imu.csv");
    std::ofstream text(path);
    text << "t_s,gx_dps,ax_g,ay_g,az_g\n";
    unsigned state = 1;
    const auto noise = [&] {
        state = state * 1664525U + 1013904223U;
        return static_cast<double>((state >> 16U) % 1000) * 1e-6;
    };
    for (int i = 0; i < 500; ++i) {
        text << i / 100.0 << ',' << noise() << ',' << noise() << ',' << noise() << ',' << 1.0 + noise()
             << '\n';
    }
    return path;
}

TEST(AnalyzeFiles, TheAccelerometerHasAFigureOfItsOwnAndIsInTheModel) {
    const TemporaryFolder folder;
    const CommandResult both = run({"analyze", write_imu_recording(folder), "--plot", folder.path("a.png"),
                                    "--histogram", folder.path("h.png"), "--model", folder.path("m.json")});
    EXPECT_EQ(both.exit_code, ExitCode::ok) << both.err;
    for (const char* name : {"a.png", "a.accelerometer.png", "h.png", "h.accelerometer.png"}) {
        EXPECT_TRUE(std::filesystem::exists(folder.path(name))) << name;
        EXPECT_NE(both.err.find(folder.path(name)), std::string::npos) << both.err;
    }
    const json model = json::parse(std::ifstream(folder.path("m.json")));
    EXPECT_GT(model["accelerometer"]["axes"]["z"]["N"].get<double>(), 0.0);
}

TEST(AnalyzeFiles, OneSensorCanBeChosen) {
    const TemporaryFolder folder;
    const std::string recording = write_imu_recording(folder);
    const CommandResult gyro = run({"analyze", recording, "--sensor", "gyro", "--json", "-"});
    EXPECT_FALSE(json::parse(gyro.out).contains("accelerometer"));
    const CommandResult accelerometer = run(
        {"analyze", recording, "--sensor", "accelerometer", "--json", "-", "--plot", folder.path("a.png")});
    EXPECT_EQ(accelerometer.exit_code, ExitCode::ok) << accelerometer.err;
    const json report = json::parse(accelerometer.out);
    EXPECT_TRUE(report["axes"].empty());
    EXPECT_EQ(report["accelerometer"]["axes"].size(), 3U);
    EXPECT_TRUE(std::filesystem::exists(folder.path("a.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.accelerometer.png")));
    const CommandResult model =
        run({"analyze", recording, "--sensor", "accelerometer", "--model", folder.path("m.json")});
    EXPECT_EQ(model.exit_code, ExitCode::usage);
    EXPECT_NE(model.err.find("a model is of a gyro"), std::string::npos) << model.err;
}

TEST(AnalyzeFiles, AnAccelerometerThatIsNotThereIsAnError) {
    const TemporaryFolder folder;
    const std::string recording = write_text_recording(folder, "gx_dps,gy_dps");
    const CommandResult result = run({"analyze", recording, "--sensor", "accelerometer"});
    EXPECT_EQ(result.exit_code, ExitCode::failed);
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("run.csv: there is no accelerometer in it"), std::string::npos) << result.err;
}

TEST_F(AnalyzeCommand, OfACaptureReportsTheAccelerometerAsAsked) {
    const json& both = usual_.report;
    ASSERT_TRUE(both.contains("accelerometer"));
    EXPECT_EQ(both["accelerometer"]["axes"]["z"]["coefficients"]["N"]["unit"], "g/sqrt(Hz)");
    EXPECT_EQ(both["accelerometer"]["gravity"]["up"], "+z");
    EXPECT_NEAR(both["accelerometer"]["gravity"]["size"]["value"].get<double>(), 1.0, 0.001);
    EXPECT_FALSE(gyro_.report.contains("accelerometer"));
    EXPECT_EQ(gyro_.report["axes"], both["axes"]);
}

TEST(AnalyzeFiles, TheReportIsShownBeforeAFileThatCannotBeWritten) {
    const TemporaryFolder folder;
    const std::string recording = write_text_recording(folder, "gx_dps,gy_dps");
    const FileSizeLimit full(0);
    for (const char* option : {"--json", "--plot", "--histogram", "--model"}) {
        const std::string path =
            folder.path(std::string("out") + (option[2] == 'p' || option[2] == 'h' ? ".png" : ".json"));
        const CommandResult result = run({"analyze", recording, option, path});
        EXPECT_NE(result.exit_code, ExitCode::ok) << option;
        EXPECT_NE(result.out.find("angle random walk"), std::string::npos) << option;
        EXPECT_NE(result.err.find(path), std::string::npos) << option << result.err;
    }
}

// Turned by hand at these times, in the first half of a minute.
std::string write_moving_recording(const TemporaryFolder& folder,
                                   const std::vector<double>& turned_at_s = {2.0, 3.1, 7.4, 12.0, 12.9, 19.3,
                                                                             24.4, 27.7}) {
    std::string path = folder.path("turned.csv");
    std::ofstream text(path);
    text << "t_s,gx_dps,ax_g,ay_g,az_g\n";
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    for (int row = 0; row < 6000; ++row) {
        const double t_s = row / 100.0;
        double rate_dps = 0.05 * noise(random);
        for (const double at_s : turned_at_s) {
            rate_dps += 90.0 * std::exp(-0.5 * std::pow((t_s - at_s) / 0.15, 2.0));
        }
        text << t_s << ',' << rate_dps << ',' << 1e-3 * noise(random) << ',' << 1e-3 * noise(random) << ','
             << 1.0 + 1e-3 * noise(random) << '\n';
    }
    return path;
}

TEST(AnalyzeFiles, NoModelIsMadeOfARecordingInMotion) {
    const TemporaryFolder folder;
    const std::string recording = write_moving_recording(folder);
    const std::string model = folder.path("m.json");
    const CommandResult result = run({"analyze", recording, "--model", model, "--json", folder.path("a.json"),
                                      "--plot", folder.path("a.png")});
    EXPECT_EQ(result.exit_code, ExitCode::failed);
    EXPECT_FALSE(std::filesystem::exists(model));
    EXPECT_NE(result.err.find("no model from a recording in motion or under vibration (gyro x)"),
              std::string::npos)
        << result.err;
    for (const char* option : {"--still auto", "--from"}) {
        EXPECT_NE(result.err.find(option), std::string::npos) << result.err;
    }
    EXPECT_TRUE(std::filesystem::exists(folder.path("a.json")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("a.png")));
    EXPECT_NE(result.out.find("the coefficients mean nothing"), std::string::npos) << result.out;
    const CommandResult at_rest = run({"analyze", recording, "--still", "auto", "--model", model});
    EXPECT_EQ(at_rest.exit_code, ExitCode::ok) << at_rest.err;
    EXPECT_TRUE(std::filesystem::exists(model));
}

TEST(AnalyzeFiles, AModelIsMadeOfARecordingThatWasTouchedOnce) {
    const TemporaryFolder folder;
    const std::string recording = write_moving_recording(folder, {2.0});
    const std::string model = folder.path("m.json");
    const CommandResult result = run({"analyze", recording, "--model", model});
    EXPECT_EQ(result.exit_code, ExitCode::ok) << result.err;
    EXPECT_TRUE(std::filesystem::exists(model));
    EXPECT_NE(result.out.find("the coefficients mean nothing"), std::string::npos) << result.out;
    EXPECT_EQ(run({"export", recording, "-o", folder.path("imu.yaml")}).exit_code, ExitCode::failed);
}

TEST(ExportFiles, NoNoiseParametersAreMadeOfARecordingInMotion) {
    const TemporaryFolder folder;
    const std::string recording = write_moving_recording(folder);
    for (const char* name : {"imu.yaml", "gyro.m", "gyro.tuning.json"}) {
        const CommandResult result = run({"export", recording, "-o", folder.path(name)});
        EXPECT_EQ(result.exit_code, ExitCode::failed) << name;
        EXPECT_NE(result.err.find("no noise parameters from a recording in motion"), std::string::npos)
            << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name;
    }
    const std::string params = folder.path("ekf.params");
    EXPECT_EQ(run({"export", recording, "--for", "px4-ekf2", "-o", params}).exit_code, ExitCode::failed);
    EXPECT_EQ(run({"export", recording, "--for", "px4-ekf2", "--from", "31", "-o", params}).exit_code,
              ExitCode::ok);
    EXPECT_EQ(run({"export", recording, "-o", folder.path("all.mat")}).exit_code, ExitCode::ok);
}

TEST(StageClock, CountsAStageThatIsEnteredAgainAsOne) {
    StageClock clock;
    for (const char* stage : {"a", "b", "a", "b", "c"}) { clock.enter(stage); }
    clock.stop();
    ASSERT_EQ(clock.stages().size(), 3U);
    EXPECT_EQ(clock.stages()[0].name, "a");
    EXPECT_EQ(clock.stages()[2].name, "c");
}

TEST(StageClock, StagesTogetherAreTheTimeThatPassed) {
    const auto begin = std::chrono::steady_clock::now();
    StageClock clock;
    for (int turn = 0; turn < 1000; ++turn) { clock.enter(turn % 2 == 0 ? "even" : "odd"); }
    clock.stop();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    double sum_s = 0.0;
    for (const StageClock::Stage& stage : clock.stages()) { sum_s += stage.wall_s; }
    EXPECT_GT(sum_s, 0.0);
    EXPECT_LE(sum_s, passed.count());
}

// What is left of a recording is analysed as a recording that holds nothing else.
TEST(AnalyzeAPart, IsAnalysingARecordingOfThatPart) {
    const TemporaryFolder folder;
    std::ofstream all(folder.path("all.csv"));
    std::ofstream part(folder.path("part.csv"));
    all << "gx_dps\n";
    part << "gx_dps\n";
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.1);
    for (int row = 0; row < 3000; ++row) {
        const bool turns = row < 600;
        const double rate_dps = noise(random) + (turns ? 20.0 * std::sin(0.1 * row) : 0.0);
        all << rate_dps << '\n';
        if (row >= 700 && row < 2700) { part << rate_dps << '\n'; }
    }
    all.close();
    part.close();
    const auto report = [&](const char* name, std::vector<std::string> options) {
        std::ostringstream out;
        std::ostringstream err;
        options.insert(options.begin(), {"analyze", folder.path(name), "--rate", "100", "--json", "-"});
        EXPECT_EQ(run_command_line(std::move(options), {out, err}), ExitCode::ok) << err.str();
        return json::parse(out.str());
    };
    const json of_part = report("part.csv", {})["axes"];
    EXPECT_EQ(report("all.csv", {"--from", "7", "--to", "27s"})["axes"], of_part);
    const json still = report("all.csv", {"--still", "auto"});
    EXPECT_NEAR(still["recording"]["duration_s"].get<double>(), 24.0, 1.01);
    EXPECT_NE(still.dump().find("this is the part from 6 s"), std::string::npos) << still["warnings"];
    // Of what the other two leave.
    EXPECT_EQ(report("all.csv", {"--from", "7", "--to", "27s", "--still", "auto"})["axes"], of_part);
}

}  // namespace
}  // namespace gyrolog
