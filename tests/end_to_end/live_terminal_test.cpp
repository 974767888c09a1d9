// The program on a terminal of its own: what is drawn, and what the keys do.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "host/session/load_capture.hpp"
#include "tests/support/program.hpp"
#include "tests/support/terminal.hpp"

namespace gyrolog {
namespace {

class LiveTerminal : public testing::Test {
protected:
    std::vector<std::string> command() const {
        return {"capture", "--device", "sim:rate=1000,realtime=1", "-o", path};
    }

    TemporaryFolder folder;
    std::string path = folder.path("live.pcapng");
};

TEST_F(LiveTerminal, MarksStopsStartsAndEndsByKeys) {
    Terminal terminal(command());
    ASSERT_TRUE(terminal.shows("samples  ")) << terminal.screen();
    EXPECT_TRUE(terminal.shows(" dps ")) << "an Allan deviation\n" << terminal.screen();
    EXPECT_TRUE(terminal.shows("  z  K ")) << terminal.screen();
    EXPECT_TRUE(terminal.shows("keys: m mark, s stop the board, q end")) << terminal.screen();
    EXPECT_FALSE(terminal.echoes());
    terminal.type("m");
    EXPECT_TRUE(terminal.shows("mark: _")) << terminal.screen();
    terminal.type("lamp on\r");
    EXPECT_TRUE(terminal.shows("m mark (1 so far)")) << terminal.screen();
    terminal.type("s");
    EXPECT_TRUE(terminal.shows("s start the board, which stands still")) << terminal.screen();
    terminal.type("s");
    EXPECT_TRUE(terminal.shows("s stop the board")) << terminal.screen();
    EXPECT_TRUE(terminal.shows("keys")) << terminal.screen();
    terminal.type("mthe end");
    EXPECT_TRUE(terminal.shows("mark: the end_")) << terminal.screen();
    terminal.type("\x03");  // Ctrl-C: the mark that was being written is kept
    EXPECT_TRUE(terminal.shows("live.pcapng: ")) << terminal.screen();
    EXPECT_TRUE(terminal.echoes());
    EXPECT_EQ(terminal.wait(), 0) << terminal.screen();

    const auto capture = load_capture(path, false);
    ASSERT_TRUE(capture.ok());
    ASSERT_EQ(capture->marks.size(), 2U);
    EXPECT_EQ(capture->marks[0].text, "lamp on");
    EXPECT_EQ(capture->marks[1].text, "the end");
    const LinkReport link = capture->decoder->report();
    EXPECT_EQ(link.runs, 2U);
    EXPECT_TRUE(link.complete());
    EXPECT_EQ(capture->file.blocks.end, FileEnd::clean);
    const std::string info = run_gyrolog({"info", path}).out;
    EXPECT_NE(info.find("mark       at "), std::string::npos) << info;
    EXPECT_NE(info.find(" s  lamp on\n"), std::string::npos) << info;
}

// The seconds behind "stopped by the user for"; 0 where that is not said.
double stopped_s(const std::string& text) {
    const std::string words = "stopped by the user for ";
    const std::size_t at = text.find(words);
    if (at == std::string::npos) { return 0.0; }
    char* unit = nullptr;
    const double number = std::strtod(text.c_str() + at + words.size(), &unit);
    return std::string(unit, 3) == " ms" ? number * 1e-3 : number;
}

// Red for an error, on a terminal that has not refused colour, and nowhere else.
TEST(TerminalColours, AreForErrorsOnTerminalsThatTakeThem) {
    const auto shown = [](const char* no_color) {
        if (no_color == nullptr) {
            unsetenv("NO_COLOR");
        } else {
            setenv("NO_COLOR", no_color, 1);
        }
        Terminal terminal({"analyze", "none.csv"});
        EXPECT_EQ(terminal.wait(), 1);
        return terminal.screen();
    };
    setenv("TERM", "xterm", 1);
    EXPECT_NE(shown(nullptr).find("\x1b[31mgyrolog analyze: read 'none.csv': no such file\x1b[0m"),
              std::string::npos);
    EXPECT_NE(shown("").find("\x1b[31m"), std::string::npos) << "empty is not set (no-color.org)";
    EXPECT_EQ(shown("1").find('\x1b'), std::string::npos);
    unsetenv("NO_COLOR");
    setenv("TERM", "dumb", 1);
    EXPECT_EQ(shown(nullptr).find('\x1b'), std::string::npos);
    setenv("TERM", "xterm", 1);
    EXPECT_EQ(run_gyrolog({"analyze", "none.csv"}).err.find('\x1b'), std::string::npos);
    // What comes from outside still commands nobody.
    Terminal terminal({"analyze", "\x1b[2J.csv"});
    EXPECT_EQ(terminal.wait(), 1);
    EXPECT_EQ(terminal.screen().find("\x1b[2J"), std::string::npos);
}

TEST_F(LiveTerminal, AStopIsToldAlikeWhereverTheCaptureIsToldOf) {
    Terminal terminal(command());
    ASSERT_TRUE(terminal.shows("s stop the board")) << terminal.screen();
    // Text has stamps only: in a few seconds, a stop longer than what was captured could be a burst's pause.
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    terminal.type("s");
    ASSERT_TRUE(terminal.shows("s start the board")) << terminal.screen();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    terminal.type("s");
    ASSERT_TRUE(terminal.shows("s stop the board")) << terminal.screen();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    terminal.type("q");
    ASSERT_EQ(terminal.wait(), 0) << terminal.screen();
    const double told_s = stopped_s(terminal.screen());
    EXPECT_GE(told_s, 0.5) << terminal.screen();
    const std::string csv = folder.path("live.csv");
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"info", path},
                                               {"check", path},
                                               {"analyze", path},
                                               {"export", path, "-o", csv},
                                               {"analyze", csv}}) {
        const ProgramResult result = run_gyrolog(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const std::string text = result.out + result.err;
        EXPECT_NEAR(stopped_s(text), told_s, 0.01 * told_s) << text;
        EXPECT_EQ(text.find(" missing in "), std::string::npos) << text;
    }
    EXPECT_NE(run_gyrolog({"check", path}).out.find("nothing is missing"), std::string::npos);
    EXPECT_NE(run_gyrolog({"info", path}).out.find("missing    no sample"), std::string::npos);
    EXPECT_NE(run_gyrolog({"analyze", path}).out.find("no dropouts"), std::string::npos);
}

TEST_F(LiveTerminal, EndsByItsKeyAndLeavesTheTerminalAsItWas) {
    Terminal terminal(command());
    ASSERT_TRUE(terminal.shows("keys:")) << terminal.screen();
    EXPECT_FALSE(terminal.echoes());
    terminal.type("q");
    EXPECT_TRUE(terminal.shows("live.pcapng: ")) << terminal.screen();
    EXPECT_TRUE(terminal.echoes());
    EXPECT_EQ(terminal.wait(), 0) << terminal.screen();
}

// A shell takes the terminal meanwhile, with a mode of its own.
TEST_F(LiveTerminal, StoppedAndContinuedItTakesItsKeysAgainAndLosesNothing) {
    Terminal terminal(command());
    ASSERT_TRUE(terminal.shows("keys:")) << terminal.screen();
    terminal.send(SIGSTOP);
    terminal.set_echo(true);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_TRUE(terminal.echoes());
    terminal.send(SIGCONT);
    ASSERT_TRUE(terminal.shows("keys:")) << terminal.screen();
    ASSERT_TRUE(terminal.shows("keys:")) << terminal.screen();
    EXPECT_FALSE(terminal.echoes());
    terminal.type("q");
    EXPECT_TRUE(terminal.shows("live.pcapng: ")) << terminal.screen();
    EXPECT_TRUE(terminal.echoes());
    EXPECT_EQ(terminal.wait(), 0) << terminal.screen();
    const auto capture = load_capture(path, false);
    ASSERT_TRUE(capture.ok());
    EXPECT_TRUE(capture->decoder->report().complete());
}

TEST_F(LiveTerminal, EverySignalThatEndsItGivesTheTerminalBack) {
    for (const int number : {SIGQUIT, SIGABRT, SIGTRAP, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGALRM, SIGSTKFLT,
                             SIGRTMIN, SIGRTMIN + 5, SIGRTMAX}) {
        Terminal terminal(command());
        ASSERT_TRUE(terminal.shows("keys:")) << terminal.screen();
        EXPECT_FALSE(terminal.echoes());
        terminal.send(number);
        const bool tidy = number != SIGQUIT && number != SIGABRT && number != SIGTRAP;
        EXPECT_EQ(terminal.wait(), tidy ? 0 : 128 + number) << terminal.screen();
        EXPECT_TRUE(terminal.echoes()) << number;
        std::filesystem::remove(path);
    }
}

// A job of a shell, behind whose back the user types for others.
TEST_F(LiveTerminal, InTheBackgroundItDrawsNothingAndTakesNoKey) {
    std::vector<std::string> arguments = command();
    arguments.insert(arguments.end(), {"--duration", "1.5s"});
    Terminal terminal(arguments, Terminal::Place::background);
    ASSERT_TRUE(terminal.shows("capturing from")) << terminal.screen();
    terminal.type("q");
    EXPECT_TRUE(terminal.echoes());
    EXPECT_EQ(terminal.wait(), 0) << terminal.screen();
    EXPECT_NE(terminal.screen().find("1,500 samples in"), std::string::npos) << terminal.screen();
    EXPECT_EQ(terminal.screen().find("keys:"), std::string::npos) << terminal.screen();
    EXPECT_EQ(terminal.screen().find('\x1b'), std::string::npos) << terminal.screen();
}

TEST_F(LiveTerminal, NothingOfItIsDrawnOffATerminal) {
    const ProgramResult result = run_gyrolog_and_signal(command(), std::chrono::milliseconds(1500), SIGINT);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("keys"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("dps"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace gyrolog
