// The command line as scripts rely on it: exit codes, clean standard output, errors that say what to do.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;

TEST(CommandLine, NonsenseIsAUsageErrorAndTouchesNothing) {
    const TemporaryFolder folder;
    const std::string csv = folder.path("a.csv");
    std::ofstream(csv) << "t_s,gx_dps\n0,1\n1,2\n2,3\n";
    for (const std::vector<std::string>& arguments : {
             std::vector<std::string>{"frobnicate"},
             {"analyze"},
             {"analyze", csv, "--m", "1,x"},
             {"analyze", csv, "--deviation", "best"},
             {"analyze", csv, "--convention", "iso"},
             {"analyze", csv, "--rate", "-5"},
             {"analyze", csv, "--confidence", "95"},
             {"capture"},
             {"capture", "-o", folder.path("x.pcapng"), "--device", "floppy:"},
             {"capture", "-o", folder.path("x.pcapng"), "--device", "sim:colour=red"},
             {"capture", "-o", folder.path("x.pcapng"), "--device", "sim:", "--duration", "soon"},
             {"capture", "-o", folder.path("x.pcapng"), "--device", "sim:", "--dlpf", "wide"},
             {"check", "a", "b"},
         }) {
        const ProgramResult result = run_gyrolog(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments.front() << ' ' << arguments.back() << ": " << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find("gyrolog"), std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(folder.path("x.pcapng")));
    }
}

TEST(CommandLine, HelpAndVersionAreResults) {
    const ProgramResult help = run_gyrolog({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* command : {"list", "capture", "info", "check", "recover", "analyze"}) {
        EXPECT_NE(help.out.find(command), std::string::npos) << command;
        EXPECT_EQ(run_gyrolog({command, "--help"}).exit_code, 0);
    }
    EXPECT_THAT(run_gyrolog({"--version"}).out,
                testing::MatchesRegex("gyrolog [0-9]+\\.[0-9]+\\.[0-9]+( \\([0-9A-Za-z.-]+\\))?\n"));
}

TEST(CommandLine, CapturesAndReportsNameTheProgramAsItNamesItself) {
    const TemporaryFolder folder;
    const std::string capture = folder.path("a.pcapng");
    const std::string version = run_gyrolog({"--version"}).out;
    const std::string name = version.substr(0, version.size() - 1);
    ASSERT_EQ(run_gyrolog({"capture", "--device", "sim:rate=100,seed=1", "--duration", "60", "-o", capture})
                  .exit_code,
              0);
    const json info = json::parse(run_gyrolog({"info", capture, "--json", "-"}).out);
    EXPECT_EQ(info["program"], name);
    EXPECT_EQ(info["reported_by"], name);
    for (const char* command : {"check", "analyze"}) {
        const ProgramResult report = run_gyrolog({command, capture, "--json", "-"});
        ASSERT_EQ(report.exit_code, 0) << report.err;
        EXPECT_EQ(json::parse(report.out)["reported_by"], name) << command;
    }
    // What is simulated is the same for the same seed, whichever commit made it.
    const std::string model = folder.path("a.json");
    const std::string csv = folder.path("a.csv");
    ASSERT_EQ(run_gyrolog({"analyze", capture, "--model", model}).exit_code, 0);
    ASSERT_EQ(run_gyrolog({"simulate", model, "-o", csv, "--duration", "10"}).exit_code, 0);
    EXPECT_EQ(read_whole_file(csv).find(name), std::string::npos);
}

TEST(CommandLine, AMissingFileIsNamedAndStandardOutputStaysClean) {
    for (const char* command : {"analyze", "info", "check"}) {
        const ProgramResult result = run_gyrolog({command, "no/such/night.pcapng", "--json", "-"});
        EXPECT_EQ(result.exit_code, 1) << command;
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find("no/such/night.pcapng"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(std::string("gyrolog ") + command), std::string::npos) << result.err;
    }
}

TEST(CommandLine, AMalformedLineIsNamed) {
    const TemporaryFolder folder;
    std::ofstream(folder.path("a.csv")) << "t_s,gx_dps\n0,1\n1,two\n2,3\n";
    const ProgramResult result = run_gyrolog({"analyze", folder.path("a.csv")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("line 3"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("gx_dps"), std::string::npos) << result.err;
}

TEST(CommandLine, WithoutABoardItSaysWhatWasSoughtAndOffersTheVirtualOne) {
    const TemporaryFolder folder;
    const ProgramResult result = run_gyrolog({"-o", folder.path("x.pcapng")});
    if (result.exit_code == 0) { GTEST_SKIP() << "needs that no board is plugged in"; }
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.err.find("1209:6779"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("gyrolog --device sim:"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path("x.pcapng")));
}

TEST(CommandLine, ListAnswersInJsonEvenWhenThereIsNothing) {
    const ProgramResult result = run_gyrolog({"list", "--json", "-"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.err;
    EXPECT_EQ(json::parse(result.out)["schema"], "gyrolog-list/1");
    EXPECT_TRUE(json::parse(result.out)["devices"].is_array());
}

TEST(CommandLine, AMissingTtyIsNoDevice) {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_gyrolog({"capture", "--device", "tty:/dev/no_such_tty", "-o", folder.path("x.pcapng")});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.err.find("/dev/no_such_tty"), std::string::npos) << result.err;
}

TEST(CommandLine, ConformTellsABoardThatKeepsTheRulesFromOneThatDoesNot) {
    const ProgramResult good = run_gyrolog({"conform", "--device", "sim:"});
    EXPECT_EQ(good.exit_code, 0) << good.out;
    EXPECT_NE(good.out.find("conforms: "), std::string::npos) << good.out;
    const ProgramResult bad = run_gyrolog({"conform", "--device", "sim:breach=checksum", "--json", "-"});
    EXPECT_EQ(bad.exit_code, 7) << bad.err;
    const json answer = json::parse(bad.out);
    EXPECT_EQ(answer["schema"], "gyrolog-conform/1");
    EXPECT_EQ(answer["conforms"], false);
    EXPECT_EQ(answer["failed"], 1);
}

TEST(CommandLine, ConformWithoutADeviceThatAnswersGivesNoVerdict) {
    EXPECT_EQ(run_gyrolog({"conform", "--device", "tty:/dev/no_such_tty"}).exit_code, 3);
    EXPECT_EQ(run_gyrolog({"conform", "--device", "sim:unplug=2"}).exit_code, 4);
    const ProgramResult unknown = run_gyrolog({"conform", "--device", "sim:breach=nothing"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.err.find("checksum"), std::string::npos) << "the breaches there are: " << unknown.err;
}

}  // namespace
}  // namespace gyrolog
