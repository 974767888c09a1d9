// A handful of boards, from their recordings to the table: the program as a script runs it.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::vector<json> lines_of(const std::string& text) {
    std::vector<json> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) { lines.push_back(json::parse(line)); }
    EXPECT_TRUE(text.empty() || text.ends_with('\n'));
    return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    bool is_quoted = false;
    for (const char c : line) {
        if (c == '"') {
            is_quoted = !is_quoted;
        } else if (c == ',' && !is_quoted) {
            cells.emplace_back();
        } else {
            cells.back() += c;
        }
    }
    return cells;
}

// By column, the rows of a CSV whose cells hold no quotation mark.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
    std::istringstream in(csv);
    std::string line;
    std::vector<std::string> names;
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(in, line)) {
        std::vector<std::string> row = cells_of(line);
        if (names.empty()) {
            names = row;
            continue;
        }
        row.resize(names.size());
        auto& named = rows.emplace_back();
        for (std::size_t i = 0; i < names.size(); ++i) { named[names[i]] = row[i]; }
    }
    return rows;
}

class Fleet : public testing::Test {
protected:
    // Of one kind, but the last, which is ten times as noisy.
    void simulate_units(int units) {
        const std::string sheet = folder.path("sheet.json");
        std::ofstream(sheet) << R"({"schema": "gyrolog-population/1", "rate_hz": {"median": 100, "sd": 0.01},
            "lsb_dps": 0.001, "full_scale_dps": 250, "axes": {
            "x": {"bias": {"median": 0.1, "sd": 0.5}, "N": {"median": 0.01, "sd": 0.0005}},
            "y": {"bias": {"median": 0, "sd": 0.5}, "N": {"median": 0.01, "sd": 0.0005}},
            "z": {"bias": {"median": 0, "sd": 0.5}, "N": {"median": 0.01, "sd": 0.0005}}}})";
        const std::string loud = folder.path("loud.json");
        std::ofstream(loud) << R"({"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {"x": {"N": 0.1},
            "y": {"N": 0.1}, "z": {"N": 0.1}}})";
        for (int i = 1; i <= units; ++i) {
            const std::string file = folder.path("unit" + std::to_string(i) + ".csv");
            const ProgramResult made = run_gyrolog({"simulate", i < units ? sheet : loud, "-o", file,
                                                    "--seed", std::to_string(i), "--duration", "60s"});
            ASSERT_EQ(made.exit_code, 0) << made.err;
            recordings.push_back(file);
        }
    }
    ProgramResult run(std::vector<std::string> arguments, const std::vector<std::string>& more) {
        arguments.insert(arguments.begin() + 1, more.begin(), more.end());
        return run_gyrolog(arguments);
    }

    TemporaryFolder folder;
    std::vector<std::string> recordings;
};

TEST_F(Fleet, FromRecordingsToATableAndADataSheetOfTheirSpread) {
    simulate_units(8);
    const std::string analyses = folder.path("analyses.jsonl");
    const std::string table = folder.path("table.csv");
    const std::string population = folder.path("population.json");
    std::vector<std::string> all = recordings;
    all.push_back(folder.path("absent.csv"));
    EXPECT_EQ(run({"analyze", "--jsonl", analyses}, all).exit_code, 1);
    const ProgramResult made = run_gyrolog({"table", analyses, "-o", table, "--population", population});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err, HasSubstr("outlier: " + recordings.back() + ", axis x: N: robust z"));
    const auto rows = rows_of(read_whole_file(table));
    ASSERT_EQ(rows.size(), 8U * 3U + 1U);
    EXPECT_EQ(rows[0].at("file"), recordings[0]);
    EXPECT_EQ(rows[0].at("axis"), "x");
    EXPECT_EQ(rows[0].at("unit"), "dps");
    EXPECT_EQ(rows[0].at("outlier"), "");
    EXPECT_NEAR(std::stod(rows[0].at("N")), 0.01, 0.003);
    EXPECT_THAT(rows[21].at("outlier"), HasSubstr("N=+"));
    EXPECT_EQ(rows[24].at("exit"), "1");
    EXPECT_THAT(rows[24].at("error"), HasSubstr("absent.csv"));

    const json sheet = json::parse(read_whole_file(population));
    EXPECT_EQ(sheet["schema"], "gyrolog-population/1");
    EXPECT_NEAR(sheet["axes"]["y"]["N"]["median"].get<double>(), 0.01, 0.001);
    const ProgramResult drawn =
        run_gyrolog({"simulate", population, "-o", folder.path("drawn.csv"), "--seed", "3", "--duration",
                     "10s", "--model-out", folder.path("unit.json")});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    const json unit = json::parse(read_whole_file(folder.path("unit.json")));
    EXPECT_NEAR(unit["axes"]["y"]["N"].get<double>(), 0.01, 0.004);
}

TEST_F(Fleet, ATornAnAbsentAndAMovingRecordingAreRowsWithErrors) {
    const std::string whole = folder.path("whole.pcapng");
    const std::string torn = folder.path("torn.pcapng");
    ASSERT_EQ(run_gyrolog({"capture", "--device", "sim:rate=200,seed=3", "--duration", "10s", "-o", whole})
                  .exit_code,
              0);
    const std::string bytes = read_whole_file(whole);
    std::ofstream(torn, std::ios::binary) << bytes.substr(0, 300);
    const std::string moving = folder.path("moving.csv");
    {
        std::ofstream text(moving);
        text << "t_s,gx_dps\n";
        for (int i = 0; i < 2000; ++i) { text << i * 0.01 << ',' << (i % 7) * (i % 11) * 9 << '\n'; }
    }
    const std::string checks = folder.path("checks.jsonl");
    const std::string diagnoses = folder.path("diagnoses.jsonl");
    const std::string absent = folder.path("absent.pcapng");
    EXPECT_EQ(run_gyrolog({"check", whole, torn, absent, "--jsonl", checks}).exit_code, 1);
    EXPECT_EQ(run_gyrolog({"diagnose", moving, absent, "--auto", "--jsonl", diagnoses}).exit_code, 1);
    const std::string table = folder.path("table.csv");
    ASSERT_EQ(run_gyrolog({"table", checks, diagnoses, "-o", table}).exit_code, 0);
    const auto rows = rows_of(read_whole_file(table));
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows[0].at("file"), whole);
    EXPECT_EQ(rows[0].at("end"), "clean");
    EXPECT_EQ(rows[0].at("missing"), "0");
    EXPECT_NE(rows[0].at("started"), "");
    EXPECT_EQ(rows[1].at("file"), torn);
    EXPECT_TRUE(rows[1].at("end") == "torn_tail" || !rows[1].at("error").empty());
    EXPECT_EQ(rows[2].at("file"), absent);
    EXPECT_EQ(rows[2].at("exit"), "1");
    EXPECT_NE(rows[2].at("error"), "");
    EXPECT_EQ(rows[3].at("file"), moving);
    EXPECT_NE(rows[3].at("error"), "");
}

TEST_F(Fleet, StoppedByCtrlCLeavesWholeLines) {
    simulate_units(2);
    std::vector<std::string> many;
    for (int i = 0; i < 400; ++i) { many.push_back(recordings[static_cast<std::size_t>(i % 2)]); }
    for (const int after_ms : {50, 120, 333}) {
        const std::string lines = folder.path("lines" + std::to_string(after_ms) + ".jsonl");
        std::vector<std::string> command{"analyze", "--jsonl", lines};
        command.insert(command.end(), many.begin(), many.end());
        const ProgramResult stopped = run_gyrolog_and_signal(command, std::chrono::milliseconds(after_ms),
                                                             SIGINT, lines, FileState::holds_something);
        EXPECT_EQ(stopped.exit_code, 128 + SIGINT);
        const std::vector<json> read = lines_of(read_whole_file(lines));
        EXPECT_GE(read.size(), 1U);
        EXPECT_LT(read.size(), many.size());
        for (const json& line : read) { EXPECT_EQ(line["schema"], "gyrolog-analysis/1"); }
    }
}

TEST_F(Fleet, DoctorAnswersInBothForms) {
    const ProgramResult text = run_gyrolog({"doctor"});
    EXPECT_TRUE(text.exit_code == 0 || text.exit_code == 1) << text.err;
    const ProgramResult answer = run_gyrolog({"doctor", "--json", "-"});
    const json found = json::parse(answer.out);
    EXPECT_EQ(found["schema"], "gyrolog-doctor/1");
    EXPECT_EQ(found["ok"], text.exit_code == 0);
    for (const json& check : found["checks"]) {
        EXPECT_THAT(text.out, HasSubstr(check["name"].get<std::string>()));
        EXPECT_EQ(check.contains("command"), !check["ok"].get<bool>()) << check;
    }
    EXPECT_EQ(run_gyrolog({"doctor", "--root", folder.path("none")}).exit_code, 2);
}

}  // namespace
}  // namespace gyrolog
