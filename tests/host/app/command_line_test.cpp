#include "host/app/command_line.hpp"

#include <csignal>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/session/load_capture.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

// The program, called as a function.
struct Ran {
    ExitCode code = ExitCode::ok;
    std::string out;
    std::string err;
};

Ran run(std::vector<std::string> arguments, const std::atomic<int>* signal = nullptr) {
    std::ostringstream out;
    std::ostringstream err;
    const ExitCode code = run_command_line(std::move(arguments), {out, err, false, signal});
    return {code, out.str(), err.str()};
}

TEST(CommandLineInProcess, ResultsGoToOutAndMessagesToErr) {
    const TemporaryFolder folder;
    const std::string path = folder.path("run.pcapng");
    const Ran captured =
        run({"capture", "--device", "sim:rate=1000,seed=7", "--samples", "2000", "-o", path});
    EXPECT_EQ(captured.code, ExitCode::ok) << captured.err;
    EXPECT_EQ(captured.out, "");
    EXPECT_NE(captured.err.find("2,000 samples"), std::string::npos) << captured.err;
    const Ran checked = run({"check", path, "--json", "-"});
    EXPECT_EQ(checked.code, ExitCode::ok);
    EXPECT_EQ(checked.err, "");
    EXPECT_EQ(nlohmann::json::parse(checked.out)["samples"]["good"], 2000);
}

TEST(CommandLineInProcess, LossIsAnExitCodeOfItsOwn) {
    const TemporaryFolder folder;
    const std::string path = folder.path("run.pcapng");
    const Ran captured = run(
        {"capture", "--device", "sim:rate=1000,seed=7,fault=drop_packet@1", "--samples", "2000", "-o", path});
    EXPECT_EQ(captured.code, ExitCode::data_lost) << captured.err;
    EXPECT_EQ(run({"check", path}).code, ExitCode::data_lost);
    EXPECT_EQ(run({"info", path}).code, ExitCode::ok) << "info tells, and does not judge";
}

TEST(CommandLineInProcess, UnpluggedBoardIsAnExitCodeOfItsOwnAndItsDataAreSaved) {
    const TemporaryFolder folder;
    const std::string path = folder.path("run.pcapng");
    const Ran captured =
        run({"capture", "--device", "sim:rate=1000,seed=7,unplug=1.5", "--duration", "60", "-o", path});
    EXPECT_EQ(captured.code, ExitCode::device_lost);
    EXPECT_NE(captured.err.find("what came before is saved"), std::string::npos) << captured.err;
    const auto loaded = load_capture(path, false);
    ASSERT_TRUE(loaded.ok());
    EXPECT_NEAR(static_cast<double>(loaded->decoder->report().samples.good), 1500.0, 60.0);
}

TEST(CommandLineInProcess, UsersStopClosesTheFileAndIsNoFailure) {
    const TemporaryFolder folder;
    const std::string path = folder.path("run.pcapng");
    const std::atomic<int> interrupt{SIGINT};
    const Ran captured =
        run({"capture", "--device", "sim:rate=1000,seed=7,realtime=1", "-o", path}, &interrupt);
    EXPECT_EQ(captured.code, ExitCode::ok) << captured.err;
    const auto loaded = load_capture(path, false);
    ASSERT_TRUE(loaded.ok());
    EXPECT_EQ(loaded->file.blocks.end, FileEnd::clean);
    EXPECT_TRUE(loaded->last_checkpoint && loaded->last_checkpoint->last);
}

TEST(CommandLineInProcess, UnknownCommandIsAUsageErrorThatSaysWhereTheCommandsAre) {
    const Ran wrong = run({"frobnicate"});
    EXPECT_EQ(wrong.code, ExitCode::usage);
    EXPECT_EQ(wrong.out, "");
    EXPECT_NE(wrong.err.find("gyrolog --help"), std::string::npos);
}

}  // namespace
}  // namespace gyrolog
