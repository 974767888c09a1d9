// What ends a command: Ctrl-C as a terminal sends it, and the signals of other programs. Whatever it is
// doing, it ends within a second, and what it leaves is whole.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "host/base/clock.hpp"
#include "tests/support/instrumented.hpp"
#include "tests/support/program.hpp"
#include "tests/support/terminal.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr double at_once_s = GYROLOG_IS_INSTRUMENTED ? 5.0 : 1.0;

double seconds_since(std::int64_t begin_ns) {
    return static_cast<double>(host_now().monotonic_ns - begin_ns) * 1e-9;
}

struct LongCommand {
    std::vector<std::string> arguments;
    int interrupted_after_ms;
    std::string leaves;  // the name of the file that it ends tidily; empty: it leaves none
};

class Signals : public testing::Test {
protected:
    static void SetUpTestSuite() {
        inputs = std::make_unique<TemporaryFolder>();
        const std::string capture = inputs->path("short.pcapng");
        ASSERT_EQ(
            run_gyrolog({"capture", "--device", "sim:rate=1000,seed=7", "--duration", "20s", "-o", capture})
                .exit_code,
            0);
        ASSERT_EQ(run_gyrolog({"capture", "--device", "sim:rate=1000,seed=7", "--duration", "1h", "-o",
                               inputs->path("long.pcapng")})
                      .exit_code,
                  0);
        ASSERT_EQ(run_gyrolog({"analyze", capture, "--model", inputs->path("model.json")}).exit_code, 0);
        ASSERT_EQ(run_gyrolog({"simulate", inputs->path("model.json"), "-o", inputs->path("long.csv"),
                               "--duration", "10min", "--rate", "1000"})
                      .exit_code,
                  0);
    }
    static void TearDownTestSuite() { inputs.reset(); }

    static std::string input(const char* name) { return inputs->path(name); }

    std::vector<LongCommand> commands() const {
        const std::string text = input("long.csv");
        const std::string model = input("model.json");
        const std::string json = folder.path("a.json");
        return {
            {{"analyze", text, "--m", "all", "--json", json}, 500, ""},
            {{"export", text, "-o", folder.path("e.csv.xz")}, 500, ""},
            {{"compare", text, model, "--json", json}, 500, ""},
            {{"diagnose", text, "--model", model, "--json", json}, 500, ""},
            {{"denoise", text, "-o", folder.path("d.csv.xz")}, 500, ""},
            {{"simulate", model, "-o", folder.path("s.csv.xz"), "--duration", "5d"}, 500, "s.csv.xz"},
            {{"simulate", model, "-o", folder.path("s.pcapng"), "--duration", "50d"}, 500, "s.pcapng"},
            {{"capture", "--device", "sim:rate=1000,realtime=1", "--duration", "1h", "-o",
              folder.path("c.pcapng")},
             800,
             "c.pcapng"},
            {{"capture", "--device", "sim:rate=1000,boards=2,realtime=1", "--duration", "1h", "-o",
              folder.path("b.pcapng")},
             800,
             "b-SIM0002.pcapng"},
            // In the middle of the run that it listens to for seven seconds.
            {{"conform", "--device", "sim:rate=1000,realtime=1", "--json", json}, 6000, ""},
        };
    }

    std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : fs::directory_iterator(fs::path(folder.path("x")).parent_path())) {
            found.insert(entry.path().filename().string());
        }
        return found;
    }
    void expect_tidy_end(const LongCommand& command, int number) {
        const std::string what =
            command.arguments[0] + " to " + command.leaves + ", signal " + std::to_string(number);
        const ProgramResult result =
            run_gyrolog_and_signal(command.arguments, milliseconds(command.interrupted_after_ms), number);
        ASSERT_NE(result.signalled_ns, 0) << what << ": it has too little to do for this test";
        EXPECT_LE(seconds_since(result.signalled_ns), at_once_s) << what;
        EXPECT_EQ(result.exit_code, 128 + number) << what << '\n' << result.err;
        expect_whole(command, what);
    }
    // Nothing but what it ended tidily, which is whole.
    void expect_whole(const LongCommand& command, const std::string& what) {
        for (const std::string& name : names()) {
            EXPECT_FALSE(command.leaves.empty()) << what << " left " << name;
            const bool text = name.ends_with(".csv.xz");
            const std::string copy = folder.path("copy.csv");
            const ProgramResult read = text ? run_gyrolog({"export", folder.path(name), "-o", copy})
                                            : run_gyrolog({"check", folder.path(name)});
            EXPECT_EQ(read.exit_code, 0) << what << ": " << read.out << read.err;
            fs::remove(copy);
        }
        if (!command.leaves.empty()) { EXPECT_EQ(names().count(command.leaves), 1U) << what; }
        for (const std::string& name : names()) { fs::remove(folder.path(name)); }
    }

    static std::unique_ptr<TemporaryFolder> inputs;
    TemporaryFolder folder;
};

std::unique_ptr<TemporaryFolder> Signals::inputs;

TEST_F(Signals, CtrlCOnATerminalEndsEveryCommand) {
    for (const LongCommand& command : commands()) {
        const std::string what = command.arguments[0] + " to " + command.leaves;
        Terminal terminal(command.arguments);
        std::this_thread::sleep_for(milliseconds(command.interrupted_after_ms));
        const std::int64_t typed_ns = host_now().monotonic_ns;
        terminal.type("\x03");
        EXPECT_EQ(terminal.wait(), 128 + SIGINT) << what << '\n' << terminal.screen();
        EXPECT_LE(seconds_since(typed_ns), at_once_s) << what;
        expect_whole(command, what);
    }
}

TEST_F(Signals, OfOtherProgramsEndEveryCommand) {
    for (const LongCommand& command : commands()) { expect_tidy_end(command, SIGTERM); }
}

// Limits of processor time and timers send these, and people who take SIGUSR1 for a question. Without a
// handler the exit code is the same, but what was written stays an unfinished file.
TEST_F(Signals, OfLimitsAndTimersAreTidyToo) {
    const std::vector<LongCommand> all = commands();
    const auto writes =
        std::ranges::find_if(all, [](const LongCommand& command) { return !command.leaves.empty(); });
    ASSERT_NE(writes, all.end());
    for (const int number : {SIGXCPU, SIGUSR1, SIGUSR2, SIGALRM, SIGPROF, SIGRTMIN}) {
        expect_tidy_end(*writes, number);
    }
}

// Ctrl-\ ends everything at once, as a crash does. A capture is there as far as it was written.
TEST_F(Signals, AQuitLeavesNoPartOfAFile) {
    for (const LongCommand& command : commands()) {
        const std::string what = command.arguments[0] + " to " + command.leaves;
        const ProgramResult result =
            run_gyrolog_and_signal(command.arguments, milliseconds(command.interrupted_after_ms), SIGQUIT);
        ASSERT_NE(result.signalled_ns, 0) << what << ": it has too little to do for this test";
        EXPECT_LE(seconds_since(result.signalled_ns), at_once_s) << what;
        EXPECT_EQ(result.exit_code, 128 + SIGQUIT) << what << '\n' << result.err;
        for (const std::string& name : names()) {
            EXPECT_TRUE(name.ends_with(".pcapng")) << what << " left " << name;
            EXPECT_EQ(run_gyrolog({"check", folder.path(name)}).exit_code, 0) << what;
            fs::remove(folder.path(name));
        }
    }
}

// The bare program's first Ctrl-C ends the capture. One in the analysis that follows ends that, and the
// capture stays.
TEST_F(Signals, CtrlCInTheAnalysisAfterACaptureEndsIt) {
    const std::string path = folder.path("a.pcapng");
    Terminal terminal({"--device", "replay:" + input("long.pcapng"), "-o", path});
    ASSERT_TRUE(terminal.shows("samples in")) << terminal.screen();
    const std::int64_t typed_ns = host_now().monotonic_ns;
    terminal.type("\x03");
    EXPECT_EQ(terminal.wait(), 128 + SIGINT) << terminal.screen();
    EXPECT_LE(seconds_since(typed_ns), at_once_s);
    EXPECT_EQ(run_gyrolog({"check", path}).exit_code, 0);
}

TEST_F(Signals, ARecoveryThatIsInterruptedLeavesNoFile) {
    const std::string path = folder.path("r.pcapng");
    unsigned interrupted = 0;
    for (const int after_ms : {0, 10, 20, 40, 60, 80, 100}) {
        const ProgramResult result = run_gyrolog_and_signal({"recover", input("long.pcapng"), "-o", path},
                                                            milliseconds(after_ms), SIGINT);
        const bool done = result.exit_code == 0;
        EXPECT_TRUE(done || result.exit_code == 128 + SIGINT) << result.err;
        EXPECT_EQ(names().empty(), !done) << after_ms;
        interrupted += done ? 0U : 1U;
        fs::remove(path);
    }
    EXPECT_GE(interrupted, 1U) << "it has too little to do for this test";
}

TEST_F(Signals, AnIgnoredInterruptStaysIgnored) {
    struct sigaction ignored {};
    ignored.sa_handler = SIG_IGN;
    struct sigaction before {};
    sigaction(SIGINT, &ignored, &before);
    const ProgramResult result = run_gyrolog_and_signal({"capture", "--device", "sim:rate=1000,realtime=1",
                                                         "--duration", "1s", "-o", folder.path("a.pcapng")},
                                                        milliseconds(300), SIGINT);
    sigaction(SIGINT, &before, nullptr);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("1,000 samples"));
}

// ------------------------------------------------------------------------------------------- a serial port

// A port whose board says nothing: a capture waits for it, with the port's settings changed.
class SilentPort {
public:
    SilentPort() {
        EXPECT_EQ(openpty(&board_, &line_, nullptr, nullptr, nullptr), 0);
        found_ = settings();
        cfsetispeed(&found_, B19200);
        cfsetospeed(&found_, B19200);
        EXPECT_EQ(tcsetattr(line_, TCSANOW, &found_), 0);
        found_ = settings();
        EXPECT_TRUE(echoes());
    }
    SilentPort(const SilentPort&) = delete;
    SilentPort& operator=(const SilentPort&) = delete;
    ~SilentPort() {
        close(line_);
        close(board_);
    }
    std::string uri() const { return std::string("tty:") + ptsname(board_) + ",speed=921600"; }
    bool echoes() const { return (settings().c_lflag & static_cast<tcflag_t>(ECHO)) != 0; }
    bool is_in_use() const {
        const termios now = settings();
        return !echoes() && cfgetospeed(&now) == B921600;
    }
    void expect_as_found(const std::string& what) const {
        const termios now = settings();
        EXPECT_EQ(now.c_iflag, found_.c_iflag) << what;
        EXPECT_EQ(now.c_oflag, found_.c_oflag) << what;
        EXPECT_EQ(now.c_cflag, found_.c_cflag) << what;
        EXPECT_EQ(now.c_lflag, found_.c_lflag) << what;
        EXPECT_EQ(cfgetospeed(&now), cfgetospeed(&found_)) << what;
    }

private:
    termios settings() const {
        termios now{};
        EXPECT_EQ(tcgetattr(line_, &now), 0);
        return now;
    }

    int board_ = -1;
    int line_ = -1;
    termios found_{};
};

bool comes_true(const std::function<bool()>& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) { std::this_thread::sleep_for(milliseconds(10)); }
    return condition();
}

TEST_F(Signals, ACaptureThatWaitsForItsBoardEndsAndPutsThePortBack) {
    const std::string path = folder.path("a.pcapng");
    for (const std::vector<int>& numbers : std::vector<std::vector<int>>{{SIGINT},
                                                                         {SIGTERM},
                                                                         {SIGHUP},
                                                                         {SIGQUIT},
                                                                         {SIGABRT},
                                                                         {SIGUSR1},
                                                                         {SIGXCPU},
                                                                         {SIGALRM},
                                                                         {SIGINT, SIGINT},
                                                                         {SIGTSTP, SIGCONT, SIGINT}}) {
        for (const bool configured : {false, true}) {
            const std::string what =
                "signal " + std::to_string(numbers.front()) + (configured ? ", asked" : "");
            const SilentPort port;
            std::vector<std::string> command{gyrolog_path(), "capture", "--device", port.uri(), "-o", path};
            if (configured) { command.insert(command.end(), {"--rate", "1000"}); }
            const pid_t child = start_program(command, -1, -1);
            EXPECT_TRUE(comes_true([&] { return port.is_in_use(); })) << what;
            std::this_thread::sleep_for(milliseconds(200));
            const std::int64_t sent_ns = host_now().monotonic_ns;
            for (const int number : numbers) { kill(child, number); }
            int status = 0;
            waitpid(child, &status, 0);
            EXPECT_LE(seconds_since(sent_ns), at_once_s) << what;
            const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
            EXPECT_EQ(code, 128 + numbers.back()) << what;
            port.expect_as_found(what);
            // One that ends the program at once leaves what a kill would leave. Twins are one.
            const bool tidy = numbers.front() != SIGQUIT && numbers.front() != SIGABRT;
            if (tidy) { EXPECT_FALSE(fs::exists(path)) << what << ": nothing came"; }
            fs::remove(path);
        }
    }
}

}  // namespace
}  // namespace gyrolog
