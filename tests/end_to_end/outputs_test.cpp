// What a command writes: never over what it reads, whole or not at all, and whatever becomes of the one who
// reads its standard output.

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "host/base/clock.hpp"
#include "tests/support/instrumented.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class Outputs : public testing::Test {
protected:
    // A capture, its samples as text, its model, and a printed curve.
    void make_inputs() {
        ASSERT_EQ(
            run_gyrolog({"capture", "--device", "sim:rate=200,seed=7", "--duration", "20s", "-o", capture_})
                .exit_code,
            0);
        ASSERT_EQ(run_gyrolog({"export", capture_, "-o", text_}).exit_code, 0);
        ASSERT_EQ(run_gyrolog({"analyze", text_, "--model", model_}).exit_code, 0);
        std::ofstream(curve_) << "tau_s,x_dps\n1,0.01\n2,0.007\n4,0.005\n8,0.0035\n16,0.0025\n32,0.0018\n";
    }

    std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : fs::directory_iterator(fs::path(capture_).parent_path())) {
            found.insert(entry.path().filename().string());
        }
        return found;
    }

    std::vector<std::vector<std::string>> over_what_is_read() const;

    TemporaryFolder folder_;
    std::string capture_ = folder_.path("c.pcapng");
    std::string text_ = folder_.path("c.csv");
    std::string model_ = folder_.path("m.json");
    std::string curve_ = folder_.path("curve.csv");
};

// Command lines that would write over what they read, or two results into one file.
std::vector<std::vector<std::string>> Outputs::over_what_is_read() const {
    const std::string link = folder_.path("link.csv");
    const std::string other = folder_.path("other.json");
    const std::string figure = folder_.path("other.png");
    const std::string in_parent = folder_.path("../") + fs::path(text_).parent_path().filename().string();
    return {
        {"analyze", capture_, "--json", capture_},
        {"analyze", text_, "--model", text_},
        {"analyze", text_, "--json", link},
        {"analyze", link, "--json", text_},
        {"analyze", text_, "--json", folder_.path("second.csv")},
        {"analyze", text_, "--json", in_parent + "/c.csv"},
        {"analyze", text_, "--json", other, "--model", other},
        {"analyze", text_, "--plot", figure, "--histogram", figure},
        {"analyze", "--curve", curve_, "--json", curve_},
        {"check", capture_, "--json", capture_},
        {"check", capture_, "--jsonl", capture_},
        {"analyze", capture_, text_, "--jsonl", text_},
        {"compare", capture_, model_, "--jsonl", model_},
        {"compare", text_, model_, "--json", figure, "--plot", figure},
        {"table", text_, "-o", text_},
        {"table", text_, "-o", folder_.path("t.csv"), "--population", text_},
        {"table", curve_, "--expected", text_, "-o", text_},
        {"info", capture_, "--json", capture_},
        {"recover", capture_, "-o", capture_},
        {"recover", capture_, "-o", folder_.path("r.pcapng"), "--json", capture_},
        {"export", text_, "-o", text_},
        {"export", link, "-o", text_},
        {"export", model_, "-o", model_},
        {"export", model_ + "#imu", "-o", model_},
        {"calibrate", text_, "--model-out", text_},
        {"calibrate", text_, "--json", text_},
        {"calibrate", text_, "--header", text_},
        {"calibrate", text_, "--px4", other, "--ardupilot", other},
        {"compare", text_, model_, "--json", text_},
        {"conform", "--device", "replay:" + capture_, "--transcript", capture_},
        {"conform", "--device", "sim:model=" + model_, "--json", model_},
        {"diagnose", text_, "--model", model_, "--model-out", model_},
        {"diagnose", text_, "--model", model_, "--json", figure, "--plot", figure},
        {"diagnose", text_, text_, "--model", model_, "--jsonl", model_},
        {"diagnose", text_, "--model", model_, "--holdout", curve_, "--json", curve_},
        {"diagnose", text_, "--model", model_, "--ask", curve_, "--json", curve_},
        {"diagnose", "--curve", curve_, "--json", curve_},
        {"report", text_, "-o", text_},
        {"report", text_, "--model", model_, "-o", model_},
        {"denoise", text_, "-o", text_},
        {"denoise", text_, "--model", model_, "--json", model_},
        {"denoise", text_, "--model", curve_, model_, "--json", model_},
        {"denoise", "sim:boards=2,model=" + model_, "--json", model_},
        {"denoise", text_, "--calibration", curve_, "--json", curve_},
        {"denoise", text_, "--plot", figure, "--json", figure},
        {"simulate", model_, "-o", text_, "--model-out", model_},
        {"simulate", model_, "--like", text_, "-o", text_},
        {"simulate", model_, "--like", text_, "-o", folder_.path("s.csv"), "--json", text_},
        {"capture", "--device", "replay:" + capture_, "-o", capture_, "--force"},
        {"capture", "--device", "sim:model=" + model_, "-o", model_, "--force"},
        {"capture", "--device", "sim:", "--samples", "10", "-o", other, "--json", other},
        {"capture", "--device", "sim:", "--samples", "10", "-o", folder_.path("n.pcapng"), "--denoise",
         "kalman", "--denoise-model", model_, "--denoise-out", model_},
        {"--device", "sim:model=" + model_, "-o", model_, "--force"},
        {"--device", "sim:model=" + folder_.path("b.model.json"), "-o", folder_.path("b.pcapng")},
    };
}

TEST_F(Outputs, AreNeverWrittenOverWhatIsRead) {
    make_inputs();
    fs::create_symlink(text_, folder_.path("link.csv"));
    fs::create_hard_link(text_, folder_.path("second.csv"));
    fs::copy_file(model_, folder_.path("b.model.json"));
    const auto before = names();
    for (const std::vector<std::string>& command : over_what_is_read()) {
        std::string line;
        for (const std::string& word : command) { line += word + " "; }
        std::array<std::string, 4> contents;
        const std::array paths{capture_, text_, model_, curve_};
        for (std::size_t i = 0; i < paths.size(); ++i) { contents[i] = read_whole_file(paths[i]); }
        const ProgramResult result = run_gyrolog(command);
        EXPECT_EQ(result.exit_code, 2) << line << result.err;
        EXPECT_THAT(result.err, AnyOf(HasSubstr("are the same file"), HasSubstr("has none of the endings")))
            << line;
        for (std::size_t i = 0; i < paths.size(); ++i) {
            EXPECT_EQ(read_whole_file(paths[i]), contents[i]) << line << "wrote over " << paths[i];
        }
    }
    EXPECT_EQ(names(), before);
}

// They are read with its first one.
TEST_F(Outputs, AreNotWrittenOverACapturesFurtherFiles) {
    const std::string first = folder_.path("r.pcapng");
    const std::vector<std::string> capture{"capture",    "--device", "sim:rate=1000,seed=7",
                                           "--duration", "4s",       "--rotate-every",
                                           "2s",         "-o",       first};
    ASSERT_EQ(run_gyrolog(capture).exit_code, 0);
    const std::string second = folder_.path("r.2.pcapng");
    const std::string contents = read_whole_file(second);
    ASSERT_FALSE(contents.empty());
    for (const char* command : {"analyze", "check", "info"}) {
        const ProgramResult result = run_gyrolog({command, first, "--json", second});
        EXPECT_EQ(result.exit_code, 2) << command;
        EXPECT_THAT(result.err, HasSubstr("are the same file")) << command;
        EXPECT_EQ(read_whole_file(second), contents) << command;
    }
    for (const char* of_another : {"n.2.pcapng", "n.17.pcapng"}) {
        std::vector<std::string> over_its_own = capture;
        over_its_own.back() = folder_.path("n.pcapng");
        over_its_own.insert(over_its_own.end(), {"--json", folder_.path(of_another)});
        const ProgramResult result = run_gyrolog(over_its_own);
        EXPECT_EQ(result.exit_code, 2) << of_another;
        EXPECT_THAT(result.err, HasSubstr("further files of the capture get such names")) << of_another;
        EXPECT_FALSE(fs::exists(over_its_own.back()));
    }
}

TEST_F(Outputs, FigureOfTheSecondSensorCostsNoOther) {
    make_inputs();
    const ProgramResult result = run_gyrolog({"analyze", capture_, "--plot", folder_.path("p.png"),
                                              "--histogram", folder_.path("p.accelerometer.png")});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr("are the same file"));
}

int run_in_shell(const std::string& command) {
    const pid_t child = start_program({"/bin/sh", "-c", command}, -1, -1);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

// The limit sends a signal before it is an error.
TEST_F(Outputs, AFileAtItsLimitIsAnErrorAndLeavesNothing) {
    make_inputs();
    const auto before = names();
    for (const std::string& command :
         {"export " + capture_ + " -o " + folder_.path("e.csv"),
          "simulate " + model_ + " -o " + folder_.path("s.csv") + " --duration 5m"}) {
        // dash counts in blocks of 512 bytes, bash of 1024.
        EXPECT_EQ(run_in_shell("ulimit -f 100; exec " + gyrolog_path() + " " + command), 6) << command;
        EXPECT_EQ(names(), before) << command;
    }
}

// Descriptor 2 would be the capture's.
TEST_F(Outputs, AClosedStandardErrorTakesNoFilesPlace) {
    const std::string capture = folder_.path("closed.pcapng");
    EXPECT_EQ(
        run_in_shell("exec " + gyrolog_path() +
                     " capture -q --device sim:rate=1000,fault=int_lost@0.3,realtime=1 --duration 3s -o " +
                     capture + " 2>&-"),
        5);
    const ProgramResult checked = run_gyrolog({"check", capture});
    EXPECT_THAT(checked.out, Not(HasSubstr("damaged"))) << checked.out;
    EXPECT_THAT(checked.out, HasSubstr("end of file: clean")) << checked.out;
}

// A new option for a file needs a row above.
TEST_F(Outputs, NoOptionForAFileIsForgotten) {
    std::set<std::string> tried;
    for (const std::vector<std::string>& command : over_what_is_read()) {
        const bool bare = command[0].starts_with('-');
        for (const std::string& word : command) {
            if (word.starts_with('-')) { tried.insert((bare ? "" : command[0] + " ") + word); }
        }
    }
    // These read no file that a result could cost; a pipe keeps nothing.
    const std::set<std::string> alone{"list --json", "doctor --json", "extcap --fifo"};
    const auto look_at = [&](const std::string& command) {
        const std::string help = run_gyrolog(command.empty() ? std::vector<std::string>{"--help"}
                                                             : std::vector<std::string>{command, "--help"})
                                     .out;
        const std::regex option("\n  (?:-(\\w),)?(--[\\w-]+) (?:FILE|RECORDING)\\b");
        std::size_t found = 0;
        for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at, ++found) {
            const std::string prefix = command.empty() ? "" : command + " ";
            const bool known = tried.contains(prefix + (*at)[2].str()) ||
                               alone.contains(prefix + (*at)[2].str()) ||
                               tried.contains(prefix + "-" + (*at)[1].str());
            EXPECT_TRUE(known) << prefix << (*at)[2] << " has no row";
        }
        return found;
    };
    std::size_t options = look_at("");
    const std::string help = run_gyrolog({"--help"}).out;
    const std::string commands = help.substr(help.find("Subcommands:"));
    const std::regex name("\n  (\\w+) ");
    for (std::sregex_iterator at(commands.begin(), commands.end(), name), end; at != end; ++at) {
        options += look_at((*at)[1]);
    }
    EXPECT_GT(options, 45U) << "the help is not read";
}

// `| head -0`: the reader is gone before the first byte.
TEST_F(Outputs, AreAllWrittenWhereNobodyReadsTheReport) {
    make_inputs();
    const std::string json = folder_.path("a.json");
    const std::string plot = folder_.path("a.png");
    const std::vector<std::vector<std::string>> commands{
        {"analyze", text_, "--json", json, "--plot", plot},
        {"analyze", "--curve", curve_, "--json", json, "--plot", plot},
        {"compare", text_, model_, "--simulations", "39", "--json", json, "--plot", plot},
        {"diagnose", text_, "--model", model_, "--simulations", "39", "--json", json, "--plot", plot},
        {"denoise", text_, "--json", json, "--plot", plot},
        {"check", capture_, "--json", json},
        {"info", capture_, "--json", json},
    };
    for (const std::vector<std::string>& arguments : commands) {
        fs::remove(json);
        fs::remove(plot);
        std::vector<std::string> command{gyrolog_path()};
        command.insert(command.end(), arguments.begin(), arguments.end());
        std::array<int, 2> out{};
        ASSERT_EQ(pipe2(out.data(), O_CLOEXEC), 0);
        close(out[0]);
        const std::string errors = folder_.path("err");
        const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        const pid_t child = start_program(command, out[1], err);
        close(out[1]);
        close(err);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFEXITED(status)) << arguments[0];
        EXPECT_EQ(WEXITSTATUS(status), 0) << arguments[0];
        EXPECT_THAT(read_whole_file(errors), Not(HasSubstr("standard output"))) << arguments[0];
        EXPECT_GT(read_whole_file(json).size(), 100U) << arguments[0];
        const bool draws = arguments.back() == plot;
        if (draws) { EXPECT_GT(read_whole_file(plot).size(), 1000U) << arguments[0]; }
    }
}

TEST_F(Outputs, AFileThatCannotBeWrittenCostsNoOther) {
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    make_inputs();
    const std::string plot = folder_.path("a.png");
    const std::string full = folder_.path("full.json");
    fs::create_symlink("/dev/full", full);
    const ProgramResult result = run_gyrolog({"analyze", text_, "--json", full, "--plot", plot});
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_THAT(result.err, HasSubstr("full.json': disk full"));
    EXPECT_THAT(result.out, HasSubstr("4,000 samples"));
    EXPECT_GT(read_whole_file(plot).size(), 1000U);
}

// Before anything is read and computed: whatever the recording is, the directory is what is told of.
TEST_F(Outputs, AreTriedBeforeTheWorkIsDone) {
    make_inputs();
    const std::string no_json = folder_.path("no/a.json");
    const std::string no_plot = folder_.path("no/a.png");
    const std::string no_text = folder_.path("no/a.csv");
    const std::string no_capture = folder_.path("no/a.pcapng");
    std::ofstream(folder_.path("bad.csv")) << "no recording";
    const std::string bad = folder_.path("bad.csv");
    const auto before = names();
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"--device", "sim:", "-o", no_capture},
             {"list", "--json", no_json},
             {"capture", "--device", "sim:", "-o", no_capture},
             {"capture", "--device", "sim:", "-o", folder_.path("a.pcapng"), "--json", no_json},
             {"capture", "--device", "sim:", "-o", folder_.path("a.pcapng"), "--denoise", "kalman",
              "--denoise-out", no_text},
             {"info", bad, "--json", no_json},
             {"check", bad, "--json", no_json},
             {"recover", bad, "-o", no_capture},
             {"recover", bad, "-o", folder_.path("a.pcapng"), "--json", no_json},
             {"analyze", bad, "--json", no_json},
             {"analyze", bad, "--plot", no_plot},
             {"analyze", bad, "--histogram", no_plot},
             {"analyze", bad, "--model", no_json},
             {"analyze", "--curve", bad, "--json", no_json},
             {"analyze", "--curve", bad, "--plot", no_plot},
             {"analyze", "--curve", bad, "--model", no_json},
             {"calibrate", bad, "--json", no_json},
             {"calibrate", bad, "--model-out", no_json},
             {"calibrate", bad, "--px4", folder_.path("no/a.params")},
             {"calibrate", bad, "--ardupilot", folder_.path("no/a.param")},
             {"calibrate", bad, "--header", folder_.path("no/a.h")},
             {"compare", bad, bad, "--json", no_json},
             {"compare", bad, model_, "--plot", no_plot},
             {"diagnose", bad, "--model", model_, "--json", no_json},
             {"diagnose", bad, "--model", model_, "--plot", no_plot},
             {"diagnose", bad, "--model", model_, "--model-out", no_json},
             {"diagnose", "--curve", bad, "--json", no_json},
             {"diagnose", "--curve", bad, "--plot", no_plot},
             {"diagnose", "--curve", bad, "--model", model_, "--model-out", no_json},
             {"report", bad, "-o", folder_.path("no/a.html")},
             {"denoise", bad, "-o", no_text},
             {"denoise", bad, "--json", no_json},
             {"denoise", bad, "--plot", no_plot},
             {"simulate", bad, "-o", no_text},
             {"simulate", bad, "-o", no_capture},
             {"simulate", bad, "-o", folder_.path("a.csv"), "--model-out", no_json},
             {"simulate", bad, "-o", folder_.path("a.csv"), "--json", no_json},
             {"export", bad, "-o", no_text},
             {"conform", "--device", "sim:", "--json", no_json},
             {"conform", "--device", "sim:", "--transcript", folder_.path("no/a.txt")}}) {
        std::string line;
        for (const std::string& word : command) { line += word + " "; }
        const ProgramResult result = run_gyrolog(command);
        EXPECT_EQ(result.exit_code, 1) << line << result.err;
        EXPECT_THAT(result.err, HasSubstr("/no/a.")) << line;
        EXPECT_THAT(result.err, HasSubstr("': no such directory")) << line;
        EXPECT_EQ(names(), before) << line;
    }
}

TEST_F(Outputs, AFullDiskBehindStandardOutputIsSaid) {
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    make_inputs();
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"info", capture_},
                                               {"check", capture_},
                                               {"analyze", text_},
                                               {"analyze", text_, "--json", "-"},
                                               {"analyze", "--curve", curve_},
                                               {"recover", capture_, "-o", folder_.path("r.pcapng")},
                                               {"compare", text_, text_},
                                               {"diagnose", text_, "--model", model_, "--simulations", "20"},
                                               {"denoise", text_},
                                               {"conform", "--device", "sim:"},
                                               {"--help"},
                                               {"check", "--help"},
                                               {"simulate", "--effects"}}) {
        std::vector<std::string> command{gyrolog_path()};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
        const std::string errors = folder_.path("err");
        const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        const pid_t child = start_program(command, full, err);
        close(full);
        close(err);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(WEXITSTATUS(status), 6) << arguments[0];
        EXPECT_THAT(read_whole_file(errors), HasSubstr("write to standard output: disk full"))
            << arguments[0];
    }
    EXPECT_EQ(run_gyrolog({"export", capture_, "-o", "/dev/full"}).exit_code, 2) << "no ending, no format";
    fs::create_symlink("/dev/full", folder_.path("full.mat"));
    fs::create_symlink("/dev/full", folder_.path("full.csv"));
    EXPECT_EQ(run_gyrolog({"export", capture_, "-o", folder_.path("full.mat")}).exit_code, 6);
    EXPECT_EQ(run_gyrolog({"export", capture_, "-o", folder_.path("full.csv")}).exit_code, 6);
}

// At any stage: reading, working, writing.
TEST_F(Outputs, OneSignalEndsEveryCommandAtOnceAndLeavesNoHalfFile) {
    make_inputs();
    const std::string long_text = folder_.path("long.csv");
    ASSERT_EQ(
        run_gyrolog({"simulate", model_, "-o", long_text, "--duration", "10min", "--rate", "1000"}).exit_code,
        0);
    const auto before = names();
    const std::vector<std::vector<std::string>> commands{
        {"analyze", long_text, "--m", "all", "--json", folder_.path("a.json")},
        {"export", long_text, "-o", folder_.path("e.csv.xz")},
        {"compare", long_text, model_, "--json", folder_.path("a.json")},
        {"diagnose", long_text, "--model", model_, "--json", folder_.path("a.json")},
        {"report", long_text, "--model", model_, "-o", folder_.path("r.html")},
        {"denoise", long_text, "-o", folder_.path("d.csv.xz")},
    };
    const auto end_by = [&](const std::vector<std::string>& command, int number, int after_ms) {
        const ProgramResult result =
            run_gyrolog_and_signal(command, std::chrono::milliseconds(after_ms), number);
        const double took_s = static_cast<double>(host_now().monotonic_ns - result.signalled_ns) * 1e-9;
        const std::string what = command[0] + " after " + std::to_string(after_ms) + " ms";
        ASSERT_NE(result.signalled_ns, 0) << what << ": it has too little to do for this test";
        EXPECT_EQ(result.exit_code, 128 + number) << what;
        EXPECT_LE(took_s, GYROLOG_IS_INSTRUMENTED ? 5.0 : 1.0) << what;
        EXPECT_EQ(names(), before) << what;
    };
    for (const std::vector<std::string>& command : commands) {
        for (const int after_ms : {30, 300, 1000}) { end_by(command, SIGINT, after_ms); }
    }
    for (const int number : {SIGTERM, SIGHUP}) { end_by(commands[1], number, 500); }
}

// nohup, and a job in the background of a script.
TEST_F(Outputs, AnIgnoredSignalStaysIgnored) {
    const ProgramResult result = [&] {
        struct sigaction ignored {};
        ignored.sa_handler = SIG_IGN;
        struct sigaction before {};
        sigaction(SIGHUP, &ignored, &before);
        ProgramResult ended = run_gyrolog_and_signal(
            {"capture", "--device", "sim:rate=100,realtime=1", "--duration", "2s", "-o", capture_},
            std::chrono::milliseconds(500), SIGHUP, capture_);
        sigaction(SIGHUP, &before, nullptr);
        return ended;
    }();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.signalled_ns, 0);
    EXPECT_THAT(result.err, HasSubstr("200 samples"));
}

// Names may hold what a terminal obeys, and what another program takes for a line of code.
TEST_F(Outputs, ANameFromOutsideCommandsNobody) {
    const std::string evil = folder_.path(
        "night\x1b[2J\n\xC2\x9B"
        "31mdelete.pcapng");
    const ProgramResult captured =
        run_gyrolog({"capture", "--device", "sim:rate=1000,seed=7", "--duration", "20s", "-o", evil});
    ASSERT_EQ(captured.exit_code, 0) << captured.err;
    const std::string script = folder_.path("noise.m");
    const std::string yaml = folder_.path("noise.yaml");
    const auto shows_only = [](const std::string& text) {
        EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
        EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos) << text;
        EXPECT_EQ(text.find("\n\\u009b31m"), std::string::npos) << "its own line: " << text;
    };
    shows_only(captured.err);
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"info", evil},
                                               {"check", evil},
                                               {"analyze", evil},
                                               {"analyze", evil, "--json", "-"},
                                               {"export", evil, "-o", script},
                                               {"export", evil, "-o", yaml},
                                               {"check", evil + "none"}}) {
        const ProgramResult result = run_gyrolog(command);
        shows_only(result.out);
        shows_only(result.err);
    }
    for (const std::string& path : {script, yaml}) {
        const std::string text = read_whole_file(path);
        ASSERT_FALSE(text.empty());
        shows_only(text);
        EXPECT_THAT(text, HasSubstr("\\u000a\\u009b31mdelete"));
    }
}

// JSON is UTF-8; a file's name may be any bytes.
TEST_F(Outputs, ANameThatIsNoUtf8StandsInEveryJson) {
    const std::string odd = folder_.path("night\xFF\xC3(.pcapng");
    const ProgramResult captured =
        run_gyrolog({"capture", "--device", "sim:rate=1000,seed=7", "--duration", "20s", "-o", odd});
    ASSERT_EQ(captured.exit_code, 0) << captured.err;
    for (const char* command : {"info", "check", "analyze"}) {
        const ProgramResult result = run_gyrolog({command, odd, "--json", "-"});
        EXPECT_EQ(result.exit_code, 0) << command << ": " << result.err;
        EXPECT_TRUE(nlohmann::json::accept(result.out)) << command << ": " << result.out;
        EXPECT_THAT(result.out, HasSubstr("night\xEF\xBF\xBD")) << command;
    }
}

}  // namespace
}  // namespace gyrolog
