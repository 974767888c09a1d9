// One command on many recordings: what a line holds, what an error costs the others, and the exit code.

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class ManyRecordingsCommand : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(write_model(typical_mpu9250(), model).ok());
        for (std::uint64_t i = 0; i < 2; ++i) {
            SimulationRequest request;
            request.samples = 3000;
            request.seed = i + 1;
            ASSERT_TRUE(
                write_recording_csv(simulate_recording(typical_mpu9250(), request), i == 0 ? first : second)
                    .ok());
        }
    }

    ExitCode run(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        return run_command_line(std::move(arguments), {out, err});
    }
    std::vector<json> lines_of(const std::string& text) {
        std::vector<json> parsed;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) { parsed.push_back(json::parse(line)); }
        EXPECT_TRUE(text.ends_with('\n'));
        return parsed;
    }

    TemporaryFolder folder;
    std::string model = folder.path("model.json");
    std::string first = folder.path("a.csv");
    std::string second = folder.path("b.csv");
    std::string absent = folder.path("absent.csv");
    std::string lines = folder.path("lines.jsonl");
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(ManyRecordingsCommand, ALineIsWhatJsonWritesAndTheFile) {
    ASSERT_EQ(run({"analyze", first, "--json", "-"}), ExitCode::ok) << err.str();
    const json alone = json::parse(out.str());
    ASSERT_EQ(run({"analyze", first, second, "--jsonl", "-"}), ExitCode::ok) << err.str();
    std::vector<json> read = lines_of(out.str());
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0]["file"], first);
    EXPECT_EQ(read[1]["file"], second);
    EXPECT_GE(read[0]["seconds"].get<double>(), 0.0);
    read[0].erase("file");
    read[0].erase("seconds");
    EXPECT_EQ(read[0], alone);
}

TEST_F(ManyRecordingsCommand, OneThatCannotBeReadIsALineAndTheOthersAreDone) {
    EXPECT_EQ(run({"analyze", first, absent, second, "--jsonl", lines}), ExitCode::failed);
    const std::vector<json> read = lines_of(read_whole_file(lines));
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[0]["schema"], "gyrolog-analysis/1");
    EXPECT_FALSE(read[0].contains("exit"));
    EXPECT_EQ(read[1]["file"], absent);
    EXPECT_EQ(read[1]["exit"], 1);
    EXPECT_EQ(read[1]["command"], "analyze");
    EXPECT_THAT(read[1]["error"].get<std::string>(), HasSubstr("absent.csv"));
    EXPECT_EQ(read[2]["schema"], "gyrolog-analysis/1");
    EXPECT_THAT(err.str(), HasSubstr(absent + ":\ngyrolog analyze: "));
    EXPECT_THAT(err.str(), HasSubstr("written: " + lines));
    EXPECT_EQ(out.str(), "");
}

TEST_F(ManyRecordingsCommand, CompareTakesTheLastForAll) {
    EXPECT_EQ(run({"compare", first, second, absent, model, "--simulations", "12", "--jsonl", "-"}),
              ExitCode::failed);
    const std::vector<json> read = lines_of(out.str());
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[0]["other"], "model.json");
    EXPECT_EQ(read[1]["file"], second);
    EXPECT_EQ(read[1]["with"], "simulations");
    EXPECT_EQ(read[2]["exit"], 1);
    ASSERT_EQ(run({"compare", first, second, "--json", "-"}), ExitCode::ok) << err.str();
    EXPECT_EQ(json::parse(out.str())["other"], "b.csv") << "as it was with two";
    EXPECT_EQ(run({"compare", first}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("WITH is required"));
}

TEST_F(ManyRecordingsCommand, WhatIsOfOneRecordingIsRefusedForSeveral) {
    const std::string other = folder.path("other");
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
        {{"analyze", first, second}, "several recordings need --jsonl FILE"},
        {{"check", first, second}, "several recordings need --jsonl FILE"},
        {{"diagnose", first, second, "--auto"}, "several recordings need --jsonl FILE"},
        {{"compare", first, second, model}, "several recordings need --jsonl FILE"},
        {{"analyze", first, second, "--jsonl", lines, "--model", other}, "--model is one file"},
        {{"analyze", first, second, "--jsonl", lines, "--plot", other + ".png"}, "--plot is one file"},
        {{"diagnose", first, second, "--auto", "--jsonl", lines, "--model-out", other},
         "--model-out is one file"},
        {{"diagnose", first, second, "--auto", "--jsonl", lines, "--holdout", first},
         "--holdout is one file"},
        {{"compare", first, second, model, "--jsonl", lines, "--plot", other + ".png"}, "--plot is one file"},
        {{"analyze", first, second, "--jsonl", lines, "--json", other}, "excludes"},
        {{"analyze", first, second, "--jsonl", second}, "are the same file"},
        {{"compare", first, second, model, "--jsonl", model}, "are the same file"},
        {{"analyze", "--curve", first, "--jsonl", lines}, "excludes"},
    };
    for (const auto& [arguments, message] : wrong) {
        EXPECT_EQ(run(arguments), ExitCode::usage) << message;
        EXPECT_THAT(err.str(), HasSubstr(message));
        EXPECT_FALSE(std::filesystem::exists(lines)) << message;
    }
}

TEST_F(ManyRecordingsCommand, WithOneRecordingItsFilesAreWritten) {
    const std::string fitted = folder.path("fitted.json");
    EXPECT_EQ(run({"analyze", first, "--jsonl", lines, "--model", fitted}), ExitCode::ok) << err.str();
    EXPECT_TRUE(std::filesystem::exists(fitted));
    EXPECT_EQ(lines_of(read_whole_file(lines)).size(), 1U);
}

TEST_F(ManyRecordingsCommand, AfterASignalTheLineIsWholeAndTheLast) {
    const std::atomic<int> signal = SIGINT;
    const ExitCode code =
        run_command_line({"analyze", first, second, "--jsonl", lines}, {out, err, false, &signal});
    EXPECT_EQ(static_cast<int>(code), 128 + SIGINT);
    EXPECT_EQ(lines_of(read_whole_file(lines)).size(), 1U);
}

TEST_F(ManyRecordingsCommand, TheTableHasThemAll) {
    const std::string table = folder.path("table.csv");
    const std::string expected = folder.path("expected.txt");
    std::ofstream(expected) << first << "\n" << folder.path("lost.csv") << "\n";
    EXPECT_EQ(run({"analyze", first, absent, "--jsonl", lines}), ExitCode::failed);
    ASSERT_EQ(run({"table", lines, "-o", table, "--expected", expected}), ExitCode::ok) << err.str();
    std::string text = read_whole_file(table);
    EXPECT_EQ(std::ranges::count(text, '\n'), 1 + 3 + 1 + 1);
    EXPECT_THAT(text, HasSubstr(folder.path("lost.csv") + ","));
    EXPECT_THAT(text, HasSubstr("no answer"));
    EXPECT_THAT(err.str(), HasSubstr("gyrolog table: no answer: " + folder.path("lost.csv")));
    EXPECT_EQ(run({"table", lines, "-o", folder.path("t.txt")}), ExitCode::usage);
    EXPECT_EQ(run({"table", lines, "-o", table, "--population", folder.path("p.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("no spread between units"));
    text = read_whole_file(table);
    EXPECT_THAT(text, Not(HasSubstr("no answer"))) << "written all the same, and nothing was expected";
    std::ofstream(lines, std::ios::app) << "{\n";
    EXPECT_EQ(run({"table", lines, "-o", table}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("read '" + lines + "': line 3: no JSON"));
    EXPECT_EQ(read_whole_file(table), text) << "what was there stays";
}

TEST(WorstOf, RanksWhatACallerMustKnow) {
    EXPECT_EQ(worst_of(ExitCode::ok, ExitCode::data_lost), ExitCode::data_lost);
    EXPECT_EQ(worst_of(ExitCode::failed, ExitCode::data_lost), ExitCode::failed);
    EXPECT_EQ(worst_of(ExitCode::data_lost, ExitCode::failed), ExitCode::failed);
    EXPECT_EQ(worst_of(ExitCode::disk_full, ExitCode::usage), ExitCode::disk_full);
    EXPECT_EQ(worst_of(ended_by_signal(SIGINT), ExitCode::disk_full), ended_by_signal(SIGINT));
}

}  // namespace
}  // namespace gyrolog
