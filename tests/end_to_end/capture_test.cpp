// Captures of the virtual board through the whole program: what a user types, what stands in the files
// afterwards.

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/base/clock.hpp"
#include "host/capture/block_scanner.hpp"
#include "host/capture/input_file.hpp"
#include "tests/support/instrumented.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

// Without the line breaks of a terminal.
std::string unwrapped(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AnyOf;
using testing::HasSubstr;

class Capture : public testing::Test {
protected:
    ProgramResult capture(const std::string& device, const std::string& file,
                          std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"capture", "--device", device, "-o", folder.path(file)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_gyrolog(arguments);
    }
    json check(const std::string& file, int expected_exit_code = 0) {
        const ProgramResult result = run_gyrolog({"check", folder.path(file), "--json", "-"});
        EXPECT_EQ(result.exit_code, expected_exit_code) << result.out << result.err;
        json answer = json::parse(result.out);
        EXPECT_EQ(answer["bytes"]["total"], answer["bytes"]["in_frames"].get<std::uint64_t>() +
                                                answer["bytes"]["skipped"].get<std::uint64_t>() +
                                                answer["bytes"]["buffered"].get<std::uint64_t>());
        return answer;
    }

    TemporaryFolder folder;
};

TEST_F(Capture, OfTheVirtualBoardIsWholeAndExactlyAsLongAsAsked) {
    for (const auto& [rate, samples] : {std::pair{"100", 60000}, std::pair{"1000", 600000}}) {
        const std::string file = std::string("r") + rate + ".pcapng";
        const ProgramResult result =
            capture(std::string("sim:seed=7,rate=") + rate, file, {"--duration", "10m"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.out, "") << "messages belong on standard error";
        const json answer = check(file);
        EXPECT_EQ(answer["end"], "clean");
        EXPECT_EQ(answer["samples"]["good"], samples);
        EXPECT_EQ(answer["samples"]["missing"], 0);
        EXPECT_EQ(answer["frames"]["missing"], 0);
        EXPECT_EQ(answer["frames"]["corrupted"], 0);
        EXPECT_EQ(answer["bytes"]["skipped"], 0);
        EXPECT_TRUE(answer["dropouts"].empty());
    }
}

TEST_F(Capture, ASeedGivesTheSameSamplesAndAnotherSeedOthers) {
    ASSERT_EQ(capture("sim:seed=3", "a.pcapng", {"--duration", "5m"}).exit_code, 0);
    ASSERT_EQ(capture("sim:seed=3", "b.pcapng", {"--duration", "5m"}).exit_code, 0);
    ASSERT_EQ(capture("sim:seed=4", "c.pcapng", {"--duration", "5m"}).exit_code, 0);
    const auto analysis = [&](const char* file) {
        const ProgramResult result = run_gyrolog({"analyze", folder.path(file), "--json", "-"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out)["axes"];
    };
    EXPECT_EQ(analysis("a.pcapng"), analysis("b.pcapng"));
    EXPECT_NE(analysis("a.pcapng"), analysis("c.pcapng"));
}

TEST_F(Capture, TheBoardTakesTheRequestedConfiguration) {
    const ProgramResult result =
        capture("sim:seed=1", "a.pcapng",
                {"--duration", "5s", "--rate", "1000", "--full-scale", "250", "--dlpf", "92"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json info = json::parse(run_gyrolog({"info", folder.path("a.pcapng"), "--json", "-"}).out);
    EXPECT_EQ(info["schema"], "gyrolog-info/1");
    EXPECT_EQ(info["sensor"]["name"], "MPU-9250");
    EXPECT_EQ(info["sensor"]["rate_hz"], 1000.0);
    EXPECT_EQ(info["sensor"]["full_scale_dps"], 250);
    EXPECT_EQ(info["sensor"]["dlpf"], 92);
    EXPECT_EQ(info["samples"], 5000);
    EXPECT_NEAR(info["duration_s"].get<double>(), 5.0, 0.05);
}

TEST_F(Capture, ARefusedConfigurationSaysWhatThereIsAndLeavesNoFile) {
    const ProgramResult result = capture("sim:", "a.pcapng", {"--duration", "5s", "--full-scale", "300"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("500"), std::string::npos) << result.err;
}

TEST_F(Capture, AnExistingFileIsReplacedOnlyByForce) {
    std::ofstream(folder.path("a.pcapng")) << "precious";
    EXPECT_NE(capture("sim:", "a.pcapng", {"--duration", "5s"}).exit_code, 0);
    EXPECT_EQ(read_whole_file(folder.path("a.pcapng")), "precious");
    EXPECT_EQ(capture("sim:", "a.pcapng", {"--duration", "5s", "--force"}).exit_code, 0);
    EXPECT_EQ(check("a.pcapng")["samples"]["good"], 500);
}

TEST_F(Capture, ALostSampleIsCountedNamedAndTold) {
    const ProgramResult result =
        capture("sim:rate=1000,fault=fifo_overflow@20", "a.pcapng", {"--duration", "60s"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    const json answer = check("a.pcapng", 5);
    ASSERT_EQ(answer["dropouts"].size(), 1U);
    EXPECT_EQ(answer["dropouts"][0]["cause"], "sensor_fifo_overflow");
    EXPECT_NEAR(answer["dropouts"][0]["at_s"].get<double>(), 20.0, 1.0);
    EXPECT_EQ(answer["dropouts"][0]["samples"], answer["samples"]["missing"]);
    EXPECT_EQ(answer["samples"]["good"].get<int>() + answer["samples"]["missing"].get<int>(), 60000);
}

TEST_F(Capture, AnUnpluggedBoardLeavesAClosedAnalysableFile) {
    const ProgramResult result = capture("sim:rate=1000,unplug=30", "a.pcapng", {"--duration", "60s"});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    const json answer = check("a.pcapng");
    EXPECT_EQ(answer["end"], "clean");
    EXPECT_NEAR(answer["samples"]["good"].get<double>(), 30000.0, 100.0);
    EXPECT_EQ(run_gyrolog({"analyze", folder.path("a.pcapng"), "--json", "-"}).exit_code, 0);
}

TEST_F(Capture, ABoardThatComesBackIsOneRecordingWithAHoleOfTheTrueLength) {
    for (const auto& [option, cause, at_least, at_most] :
         {std::tuple{"", "reset", 15'000, 15'300},
          std::tuple{",self_powered=1", "unplugged", 15'000, 15'041}}) {
        const std::string file = std::string(cause) + ".pcapng";
        const ProgramResult result =
            capture(std::string("sim:rate=1000,unplug=20,replug=35") + option, file, {"--duration", "60s"});
        EXPECT_EQ(result.exit_code, 5) << result.err;
        EXPECT_NE(result.err.find("waiting for the board"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("the board is back"), std::string::npos) << result.err;
        const json answer = check(file, 5);
        EXPECT_EQ(answer["end"], "clean");
        EXPECT_EQ(answer["files"].size(), 2U);
        ASSERT_EQ(answer["dropouts"].size(), 1U);
        EXPECT_EQ(answer["dropouts"][0]["cause"], cause);
        EXPECT_NEAR(answer["dropouts"][0]["at_s"].get<double>(), 20.0, 0.05);
        // The 15 s, up to 40 ms of samples that waited for their frame to fill when the cable was pulled, and
        // the time that a board takes to boot.
        const int hole = answer["dropouts"][0]["samples"];
        EXPECT_GE(hole, at_least);
        EXPECT_LE(hole, at_most);
        EXPECT_EQ(answer["samples"]["missing"], hole);
        EXPECT_NEAR(answer["samples"]["good"].get<int>() + hole, 60'000, 300);
        const ProgramResult analysed = run_gyrolog({"analyze", folder.path(file), "--json", "-"});
        ASSERT_EQ(analysed.exit_code, 0) << analysed.err;
    }
}

TEST_F(Capture, ALostBoardIsNotWaitedForWhenToldSo) {
    const ProgramResult result = capture("sim:rate=1000,unplug=20,replug=35", "a.pcapng",
                                         {"--duration", "60s", "--on-unplug", "exit"});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_EQ(check("a.pcapng")["files"].size(), 1U);
}

TEST_F(Capture, TheWaitForALostBoardEndsAtTheFirstInterrupt) {
    const ProgramResult result =
        run_gyrolog_and_signal({"capture", "--device", "sim:rate=1000,realtime=1,unplug=0.5,replug=100000",
                                "-o", folder.path("a.pcapng")},
                               std::chrono::milliseconds(1500), SIGINT);
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("waiting for the board"), std::string::npos) << result.err;
    const json answer = check("a.pcapng");
    EXPECT_EQ(answer["end"], "clean");
    EXPECT_EQ(answer["closed"], true);
    EXPECT_GT(answer["samples"]["good"], 400);
}

TEST_F(Capture, FilesThatFollowEachOtherAreOneRecording) {
    ASSERT_EQ(capture("sim:rate=1000,seed=3", "one.pcapng", {"--duration", "60s"}).exit_code, 0);
    ASSERT_EQ(capture("sim:rate=1000,seed=3", "time.pcapng", {"--duration", "60s", "--rotate-every", "13s"})
                  .exit_code,
              0);
    ASSERT_EQ(capture("sim:rate=1000,seed=3", "size.pcapng", {"--duration", "60s", "--rotate-size", "200k"})
                  .exit_code,
              0);
    const json one = check("one.pcapng");
    const json analysis = json::parse(run_gyrolog({"analyze", folder.path("one.pcapng"), "--json", "-"}).out);
    for (const char* file : {"time.pcapng", "size.pcapng"}) {
        const json parts = check(file);
        EXPECT_GT(parts["files"].size(), 3U);
        for (const char* account : {"bytes", "frames", "samples", "dropouts"}) {
            EXPECT_EQ(parts[account], one[account]) << file;
        }
        const ProgramResult result = run_gyrolog({"analyze", folder.path(file), "--json", "-"});
        EXPECT_EQ(json::parse(result.out)["axes"], analysis["axes"]) << file;
    }
    // A file that is missing in the middle is a hole, and nothing else.
    fs::remove(folder.path("time.3.pcapng"));
    const json holed = check("time.pcapng", 5);
    EXPECT_EQ(holed["samples"]["good"].get<int>() + holed["samples"]["missing"].get<int>(), 60'000);
    ASSERT_EQ(holed["dropouts"].size(), 1U);
    EXPECT_EQ(holed["dropouts"][0]["cause"], "link");
}

TEST_F(Capture, EveryBoardHasItsOwnFile) {
    const ProgramResult all = capture("sim:rate=1000,boards=3", "a.pcapng", {"--duration", "10s"});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    for (const char* file : {"a-SIM0001.pcapng", "a-SIM0002.pcapng", "a-SIM0003.pcapng"}) {
        EXPECT_EQ(check(file)["samples"]["good"], 10'000);
    }
    EXPECT_NE(read_whole_file(folder.path("a-SIM0001.pcapng")),
              read_whole_file(folder.path("a-SIM0002.pcapng")));
    const ProgramResult two =
        capture("sim:seed=1", "b.pcapng", {"--device", "sim:seed=2,unplug=5", "--duration", "10s"});
    EXPECT_EQ(two.exit_code, 4) << "one of them was lost: " << two.err;
    EXPECT_EQ(check("b-SIM0001-1.pcapng")["samples"]["good"], 1000) << "and the other one was not";
    EXPECT_GT(check("b-SIM0001-2.pcapng")["samples"]["good"], 400);
}

TEST_F(Capture, ADiskWithoutRoomIsLeftAlone) {
    const ProgramResult result = capture("sim:", "a.pcapng", {"--duration", "5s", "--min-free", "900000T"});
    EXPECT_EQ(result.exit_code, 6) << result.err;
    EXPECT_NE(result.err.find("--min-free"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder.path("a.pcapng")));
}

TEST_F(Capture, AReplayGivesTheSameStream) {
    ASSERT_EQ(capture("sim:seed=9", "a.pcapng", {"--duration", "2m"}).exit_code, 0);
    const ProgramResult replayed = capture("replay:" + folder.path("a.pcapng"), "b.pcapng");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
    json first = check("a.pcapng");
    json second = check("b.pcapng");
    EXPECT_EQ(first["bytes"], second["bytes"]);
    EXPECT_EQ(first["samples"], second["samples"]);
}

// A file gives all of it at once, and no clock ends that.
TEST_F(Capture, AReplayEndsWhereItIsTold) {
    ASSERT_EQ(capture("sim:rate=1000,seed=9", "a.pcapng", {"--duration", "1m"}).exit_code, 0);
    const std::string device = "replay:" + folder.path("a.pcapng");
    ASSERT_EQ(capture(device, "second.pcapng", {"--duration", "1s"}).exit_code, 0);
    ASSERT_EQ(capture(device, "few.pcapng", {"--samples", "700"}).exit_code, 0);
    constexpr int transfer_samples = 500;  // of a virtual board that does not wait for the clock
    for (const auto& [file, wanted] : {std::pair{"second.pcapng", 1000}, std::pair{"few.pcapng", 700}}) {
        const int samples = check(file)["samples"]["good"];
        EXPECT_NEAR(samples, wanted, 0.01 * wanted + transfer_samples) << file;
        EXPECT_GE(samples, 0.99 * wanted) << file;
    }
}

TEST_F(Capture, AFileCutAnywhereKeepsItsGoodPrefix) {
    ASSERT_EQ(capture("sim:", "whole.pcapng", {"--duration", "1m"}).exit_code, 0);
    const std::string whole = read_whole_file(folder.path("whole.pcapng"));
    const std::uint64_t samples = check("whole.pcapng")["samples"]["good"];
    std::uint64_t samples_before = 0;
    for (int tenth = 3; tenth < 10; ++tenth) {
        const std::size_t cut = whole.size() * static_cast<std::size_t>(tenth) / 10 + 1;
        std::ofstream(folder.path("cut.pcapng"), std::ios::binary) << whole.substr(0, cut);
        const json answer = check("cut.pcapng");
        EXPECT_EQ(answer["end"], "torn_tail");
        const std::uint64_t kept = answer["samples"]["good"];
        EXPECT_GE(kept, samples_before);
        EXPECT_LT(kept, samples);
        samples_before = kept;
        fs::remove(folder.path("recovered.pcapng"));
        ASSERT_EQ(run_gyrolog({"recover", folder.path("cut.pcapng"), "-o", folder.path("recovered.pcapng")})
                      .exit_code,
                  0);
        const json recovered = check("recovered.pcapng");
        EXPECT_EQ(recovered["end"], "clean");
        EXPECT_EQ(recovered["samples"]["good"], kept);
    }
    EXPECT_GT(samples_before, 0U);
}

TEST_F(Capture, ZerosBehindTheEndAreNoFrames) {
    ASSERT_EQ(capture("sim:", "a.pcapng", {"--duration", "1m"}).exit_code, 0);
    const json before = check("a.pcapng");
    std::ofstream(folder.path("a.pcapng"), std::ios::binary | std::ios::app) << std::string(16384, '\0');
    const json after = check("a.pcapng");
    EXPECT_EQ(after["end"], "torn_tail");
    const std::string told = unwrapped(run_gyrolog({"check", folder.path("a.pcapng")}).out);
    EXPECT_THAT(told, HasSubstr("16,384 bytes stand behind its end, where its writer had closed it"));
    EXPECT_THAT(told, HasSubstr("nothing is missing; what stands behind"));
    EXPECT_THAT(run_gyrolog({"analyze", folder.path("a.pcapng")}).out,
                HasSubstr("16,384 bytes behind the end of the capture"));
    EXPECT_EQ(after["frames"], before["frames"]);
    EXPECT_EQ(after["bytes"], before["bytes"]);
}

// Told how long, a signal is no end like any other; without, it is the end that was meant.
TEST_F(Capture, AnEndBeforeTheTimeIsToldByTheExitStatusAndTheFileIsWhole) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        for (const bool limited : {true, false}) {
            const std::string path = folder.path("a.pcapng");
            std::filesystem::remove(path);
            std::vector<std::string> command{"capture", "--device", "sim:rate=100,realtime=1", "-o", path};
            if (limited) { command.insert(command.end(), {"--duration", "1h"}); }
            const ProgramResult result =
                run_gyrolog_and_signal(command, std::chrono::milliseconds(700), number, path);
            EXPECT_EQ(result.exit_code, limited ? 128 + number : 0) << result.err;
            EXPECT_EQ(result.err.find("before all that was asked for") != std::string::npos, limited)
                << result.err;
            EXPECT_EQ(check("a.pcapng")["end"], "clean");
            EXPECT_GT(check("a.pcapng")["samples"]["good"], 20);
        }
    }
}

// A board that streams on without samples, or with one and the same: its accounts of the link are in order.
TEST_F(Capture, ASensorThatFallsSilentIsToldCountedAndNoSuccess) {
    struct Case {
        const char* fault;
        double missing_s_at_least;
        double missing_s_at_most;
    };
    for (const Case& each : {Case{"int_lost@10", 49.9, 50.1}, Case{"int_lost@10..20", 9.9, 10.2},
                             Case{"sensor_reset@10", 0.1, 1.0}}) {
        const ProgramResult result = capture(std::string("sim:rate=1000,fault=") + each.fault, "a.pcapng",
                                             {"--duration", "60s", "--force"});
        EXPECT_EQ(result.exit_code, 5) << each.fault << result.err;
        const json answer = check("a.pcapng", 5);
        const double missing_s = answer["samples"]["missing"].get<double>() / 1000.0;
        EXPECT_GE(missing_s, each.missing_s_at_least) << each.fault;
        EXPECT_LE(missing_s, each.missing_s_at_most) << each.fault;
        EXPECT_EQ(answer["dropouts"][0]["cause"], "data_ready_silent") << each.fault;
        EXPECT_NEAR(answer["dropouts"][0]["at_s"].get<double>(), 10.0, 0.3) << each.fault;
    }
}

TEST_F(Capture, OneReadingAgainAndAgainIsToldCountedAndNoSuccess) {
    const ProgramResult result =
        capture("sim:rate=1000,fault=sensor_frozen@10..20", "a.pcapng", {"--duration", "60s"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    const json answer = check("a.pcapng", 5);
    EXPECT_NEAR(answer["samples"]["frozen"].get<double>(), 10'000.0, 300.0);
    EXPECT_EQ(answer["samples"]["missing"], 0);
}

// In real time, because it is the user's time that counts.
// No hole between samples shows it; what `check` counts, the analysis says.
TEST_F(Capture, ASensorThatIsSilentToTheEndIsToldByTheAnalysisToo) {
    ASSERT_EQ(capture("sim:rate=1000,seed=7,fault=int_lost@10", "a.pcapng", {"--duration", "30s"}).exit_code,
              5);
    const std::uint64_t missing = check("a.pcapng", 5)["samples"]["missing"];
    EXPECT_GT(missing, 19'000U);
    const ProgramResult analysis = run_gyrolog({"analyze", folder.path("a.pcapng"), "--json", "-"});
    const std::string warnings = json::parse(analysis.out)["warnings"].dump();
    EXPECT_THAT(warnings, HasSubstr("the capture goes on for 20."));
    EXPECT_THAT(warnings, HasSubstr("behind its last sample: " + std::to_string(missing / 1000) + ","));
}

TEST_F(Capture, ASilentSensorIsToldWhileItIsSilent) {
    const ProgramResult silent =
        capture("sim:rate=1000,realtime=1,fault=int_lost@0.5..3.5", "a.pcapng", {"--duration", "5s"});
    EXPECT_NE(silent.err.find("no sample for 2 s"), std::string::npos) << silent.err;
    EXPECT_NE(silent.err.find("samples come again"), std::string::npos) << silent.err;
    const ProgramResult ends =
        capture("sim:rate=1000,realtime=1,fault=int_lost@0.5", "b.pcapng", {"--duration", "4s"});
    EXPECT_NE(ends.err.find("no sample for 2 s"), std::string::npos) << ends.err;
    EXPECT_EQ(ends.err.find("samples come again"), std::string::npos) << ends.err;
    const ProgramResult frozen =
        capture("sim:rate=1000,realtime=1,fault=sensor_frozen@0.5..3.5", "c.pcapng", {"--duration", "5s"});
    EXPECT_NE(frozen.err.find("one reading comes again and again"), std::string::npos) << frozen.err;
    EXPECT_NE(frozen.err.find("the readings change again"), std::string::npos) << frozen.err;
}

TEST_F(Capture, TheSecondHalfOverwrittenIsDamageAndNotATornTail) {
    ASSERT_EQ(capture("sim:", "a.pcapng", {"--duration", "10m"}).exit_code, 0);
    const json before = check("a.pcapng");
    std::string bytes = read_whole_file(folder.path("a.pcapng"));
    std::mt19937 random(1);
    for (std::size_t i = bytes.size() / 2; i < bytes.size(); ++i) { bytes[i] = static_cast<char>(random()); }
    std::ofstream(folder.path("a.pcapng"), std::ios::binary) << bytes;
    const json after = check("a.pcapng", 5);
    EXPECT_EQ(after["end"], "damaged");
    EXPECT_LT(after["samples"]["good"], before["samples"]["good"]);
    const ProgramResult told = run_gyrolog({"check", folder.path("a.pcapng")});
    EXPECT_NE(told.out.find("something that was captured is gone"), std::string::npos) << told.out;
}

// As an editor or a careless copy does: what is left is whole, and the writer's sums say that more was there.
TEST_F(Capture, BlocksTakenOutAreMissedByTheWritersSums) {
    ASSERT_EQ(capture("sim:", "a.pcapng", {"--duration", "10m"}).exit_code, 0);
    const std::uint64_t total = check("a.pcapng")["bytes"]["total"];
    const std::string path = folder.path("a.pcapng");
    auto scanned = open_input_file(path);
    ASSERT_TRUE(scanned.ok());
    BlockScanner scanner(*std::move(scanned));
    std::string kept;
    for (int i = 0;; ++i) {
        const auto block = scanner.next();
        ASSERT_TRUE(block.ok());
        if (!*block) { break; }
        if (i >= 40 && i < 50) { continue; }
        kept.append((*block)->bytes.begin(), (*block)->bytes.end());
    }
    std::ofstream(path, std::ios::binary) << kept;
    const json after = check("a.pcapng", 5);
    EXPECT_EQ(after["end"], "clean");
    EXPECT_GT(after["bytes"]["gone"], 0);
    EXPECT_EQ(after["bytes"]["gone"].get<std::uint64_t>() + after["bytes"]["total"].get<std::uint64_t>(),
              total);
}

TEST_F(Capture, AFileThatWasNotClosedIsNeverGoodWithoutAWord) {
    ASSERT_EQ(capture("sim:", "a.pcapng", {"--duration", "1m"}).exit_code, 0);
    const auto analysis = [&](const char* name) { return run_gyrolog({"analyze", folder.path(name)}).out; };
    EXPECT_THAT(analysis("a.pcapng"), Not(AnyOf(HasSubstr("torn tail"), HasSubstr("did not close"))));
    const std::string whole = read_whole_file(folder.path("a.pcapng"));
    std::ofstream(folder.path("a.pcapng"), std::ios::binary) << whole.substr(0, whole.size() / 2);
    EXPECT_THAT(analysis("a.pcapng"), HasSubstr("warning: the file ends in a torn tail"));
    const ProgramResult torn = run_gyrolog({"check", folder.path("a.pcapng")});
    EXPECT_EQ(torn.exit_code, 0);
    EXPECT_NE(torn.out.find("before the torn tail"), std::string::npos) << torn.out;
    ASSERT_EQ(
        run_gyrolog({"recover", folder.path("a.pcapng"), "-o", folder.path("recovered.pcapng")}).exit_code,
        0);
    const ProgramResult unclosed = run_gyrolog({"check", folder.path("recovered.pcapng")});
    EXPECT_EQ(unclosed.exit_code, 0);
    EXPECT_THAT(unwrapped(unclosed.out), HasSubstr("did not close the file"));
    EXPECT_THAT(analysis("recovered.pcapng"), HasSubstr("warning: the writer did not close the file"));
}

TEST_F(Capture, RecoveryLeavesNoFileWhereItHasNothingToWrite) {
    std::ofstream(folder.path("noise.pcapng")) << std::string(5000, 'x');
    const auto recover = [&](const char* from, const std::string& to) {
        return run_gyrolog({"recover", folder.path(from), "-o", to});
    };
    const ProgramResult nothing = recover("noise.pcapng", folder.path("r.pcapng"));
    EXPECT_EQ(nothing.exit_code, 1) << nothing.err;
    EXPECT_NE(nothing.err.find("noise.pcapng"), std::string::npos) << nothing.err;
    EXPECT_FALSE(fs::exists(folder.path("r.pcapng")));
    ASSERT_EQ(capture("sim:", "a.pcapng", {"--duration", "1m"}).exit_code, 0);
    std::ofstream(folder.path("precious.pcapng")) << "precious";
    EXPECT_EQ(recover("a.pcapng", folder.path("precious.pcapng")).exit_code, 2);
    EXPECT_EQ(read_whole_file(folder.path("precious.pcapng")), "precious");
}

TEST_F(Capture, TheBareProgramCapturesUntilInterruptedAndThenAnalyses) {
    const ProgramResult result =
        run_gyrolog_and_signal({"--device", "sim:rate=1000", "-o", folder.path("s.pcapng")},
                               std::chrono::milliseconds(3000), SIGINT);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(check("s.pcapng")["end"], "clean");
    const std::uint64_t samples = check("s.pcapng")["samples"]["good"];
    EXPECT_GT(samples, 1000U);
    EXPECT_LT(samples, 4000U) << "the bare program keeps to the clock";
    EXPECT_NE(result.out.find("angle random walk"), std::string::npos) << result.out;
    EXPECT_EQ(json::parse(read_whole_file(folder.path("s.json")))["schema"], "gyrolog-analysis/1");
    EXPECT_EQ(json::parse(read_whole_file(folder.path("s.model.json")))["schema"], "gyrolog-model/1");
    EXPECT_EQ(read_whole_file(folder.path("s.png")).substr(1, 3), "PNG");
}

TEST_F(Capture, TheBareProgramEndsAtATerminationWithoutAnalysis) {
    for (const int number : {SIGTERM, SIGHUP}) {
        const std::string name = "s" + std::to_string(number) + ".pcapng";
        const ProgramResult result =
            run_gyrolog_and_signal({"--device", "sim:rate=1000", "-o", folder.path(name)},
                                   std::chrono::milliseconds(700), number, folder.path(name));
        EXPECT_LT(static_cast<double>(host_now().monotonic_ns - result.signalled_ns) * 1e-9,
                  GYROLOG_IS_INSTRUMENTED ? 5.0 : 1.0);
        EXPECT_EQ(result.exit_code, 128 + number) << result.err;
        EXPECT_NE(result.err.find("not analysed: ended by a signal"), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(check(name)["end"], "clean");
        EXPECT_FALSE(std::filesystem::exists(folder.path("s" + std::to_string(number) + ".json")));
    }
}

// Their names are the program's choice: nobody gave up what stands there.
TEST_F(Capture, TheBareProgramWritesOverNoResultUnlessForced) {
    for (const char* name : {"a.json", "a.png", "a.accelerometer.png", "a.model.json"}) {
        std::ofstream(folder.path(name)) << "precious";
        std::vector<std::string> line{"--device", "sim:rate=1000",        "--duration", "1s",
                                      "-o",       folder.path("a.pcapng")};
        const ProgramResult refused = run_gyrolog(line);
        EXPECT_EQ(refused.exit_code, 2) << name << refused.err;
        EXPECT_NE(refused.err.find(std::string(name) + "': it exists"), std::string::npos) << refused.err;
        EXPECT_FALSE(fs::exists(folder.path("a.pcapng"))) << name;
        EXPECT_EQ(read_whole_file(folder.path(name)), "precious");
        line.emplace_back("--force");
        EXPECT_EQ(run_gyrolog(line).exit_code, 0);
        EXPECT_NE(read_whole_file(folder.path(name)), "precious") << name;
        for (const char* made : {"a.pcapng", "a.json", "a.png", "a.accelerometer.png", "a.model.json"}) {
            fs::remove(folder.path(made));
        }
    }
}

TEST_F(Capture, AModelFileDrivesTheVirtualBoard) {
    ASSERT_EQ(capture("sim:", "first.pcapng", {"--duration", "2m"}).exit_code, 0);
    ASSERT_EQ(
        run_gyrolog({"analyze", folder.path("first.pcapng"), "--model", folder.path("model.json")}).exit_code,
        0);
    json model = json::parse(read_whole_file(folder.path("model.json")));
    model["axes"]["x"].update({{"N", 0.02}, {"B", 0.0}, {"K", 0.0}, {"bias", 1.5}});
    model["axes"]["y"].update({{"N", 0.04}, {"B", 0.0}, {"K", 0.0}, {"bias", -1.5}});
    std::ofstream(folder.path("model.json")) << model;
    const ProgramResult captured =
        capture("sim:model=" + folder.path("model.json"), "a.pcapng", {"--duration", "30m"});
    ASSERT_EQ(captured.exit_code, 0) << captured.err;
    const ProgramResult result = run_gyrolog({"analyze", folder.path("a.pcapng"), "--json", "-"});
    const json axes = json::parse(result.out)["axes"];
    // 180 000 samples: N is known to 1/sqrt(2 * 180000) = 0.17 %, the bias to N/sqrt(1800 s); 4 sigma each.
    EXPECT_NEAR(axes["x"]["coefficients"]["N"]["value"].get<double>(), 0.02, 0.02 * 0.01);
    EXPECT_NEAR(axes["y"]["coefficients"]["N"]["value"].get<double>(), 0.04, 0.04 * 0.01);
    EXPECT_NEAR(axes["x"]["bias"]["value"].get<double>(), 1.5, 4 * 0.02 / std::sqrt(1800.0));
    EXPECT_NEAR(axes["y"]["bias"]["value"].get<double>(), -1.5, 4 * 0.04 / std::sqrt(1800.0));
}

}  // namespace
}  // namespace gyrolog
