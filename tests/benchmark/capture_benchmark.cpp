// Processor time of a capture from a terminal line, and of `cat` from the same line into a file: at the
// ceiling of USB full speed, 1.216 MB/s, and of a board at 1 kHz. On the line's other end the virtual board
// answers commands and sends; at the ceiling its clock runs as much faster as is needed.
//
// cpu: share of one processor; ns_per_sample; bytes_per_s as they were written. Beginning and end are left
// out.

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "host/base/clock.hpp"
#include "host/virtual_board/virtual_board.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

constexpr double ceiling_bytes_per_s = 1'216'000.0;  // 19 packets of 64 bytes a millisecond
constexpr std::chrono::milliseconds warm_up(1000);
constexpr std::chrono::milliseconds measured(3000);

std::unique_ptr<VirtualBoard> board_at(double rate_hz, std::uint64_t seed = 1) {
    VirtualBoardOptions options;
    options.seed = seed;
    options.serial = "SIM" + std::to_string(seed);
    options.rate_hz = rate_hz;
    options.dlpf_hz = rate_hz > 1000.0 ? 250 : 184;
    options.ring_bytes = std::size_t{1} << 16U;
    auto board = VirtualBoard::create(std::move(options));
    if (!board.ok()) { throw std::runtime_error(board.error().message); }
    board.value()->in_endpoint().set_capacity(std::size_t{1} << 16U);
    return std::move(board).value();
}

// What a board at this rate sends in a second of its own.
double bytes_per_board_second(double rate_hz) {
    const auto board = board_at(rate_hz);
    board->on_line_state(true);
    std::vector<std::uint8_t> buffer(1U << 16U);
    double bytes = 0.0;
    for (int ms = 1; ms <= 5000; ++ms) {
        board->advance_to(std::int64_t{ms} * 1'000'000);
        bytes += static_cast<double>(board->in_endpoint().take_bytes(buffer));
    }
    return bytes / 5.0;
}

// A pseudo-terminal with a board behind it, in a thread.
class BoardLine {
public:
    BoardLine(double rate_hz, std::uint64_t seed, double hurry, bool started)
        : board_(board_at(rate_hz, seed)), hurry_(hurry) {
        line_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        if (line_ < 0 || grantpt(line_) != 0 || unlockpt(line_) != 0) { throw std::runtime_error("no pty"); }
        path_ = ptsname(line_);
        // Held open: a line without any reader hangs up.
        slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        termios mode{};
        tcgetattr(slave_, &mode);
        cfmakeraw(&mode);
        tcsetattr(slave_, TCSANOW, &mode);
        if (started) { board_->on_line_state(true); }
        thread_ = std::thread([this] { run(); });
    }
    BoardLine(const BoardLine&) = delete;
    BoardLine& operator=(const BoardLine&) = delete;
    ~BoardLine() {
        stop_ = true;
        tcflush(slave_, TCIOFLUSH);
        thread_.join();
        close(slave_);
        close(line_);
    }
    const std::string& path() const { return path_; }
    std::uint64_t bytes() const { return bytes_; }
    std::uint64_t samples() const { return samples_; }

private:
    void run() {
        constexpr std::int64_t turn_most_ns = 100'000'000;
        const std::int64_t begin_ns = clock_ns(CLOCK_MONOTONIC);
        std::int64_t now_ns = 0;
        std::vector<std::uint8_t> buffer(1U << 16U);
        while (!stop_) {
            pollfd line{line_, POLLIN, 0};
            if (poll(&line, 1, 1) > 0 && (line.revents & POLLIN) != 0) {
                const ssize_t count = read(line_, buffer.data(), buffer.size());
                if (count > 0) { board_->on_receive({buffer.data(), static_cast<std::size_t>(count)}); }
            }
            // A board whose thread did not run has not overflowed: it catches up, and what it sends tells how
            // fast the reader is.
            const auto elapsed_ns = static_cast<double>(clock_ns(CLOCK_MONOTONIC) - begin_ns);
            now_ns = std::min(static_cast<std::int64_t>(elapsed_ns * hurry_), now_ns + turn_most_ns);
            board_->advance_to(now_ns);
            send({buffer.data(), board_->in_endpoint().take_bytes(buffer)});
            samples_ = board_->sampling_instants();
        }
    }
    void send(ByteView bytes) {
        while (!bytes.empty() && !stop_) {
            const ssize_t sent = write(line_, bytes.data(), bytes.size());
            if (sent <= 0) { return; }
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
            bytes_ += static_cast<std::uint64_t>(sent);
        }
    }

    std::unique_ptr<VirtualBoard> board_;
    const double hurry_;
    int line_ = -1;
    int slave_ = -1;
    std::string path_;
    std::atomic<bool> stop_ = false;
    std::atomic<std::uint64_t> bytes_ = 0;
    std::atomic<std::uint64_t> samples_ = 0;
    std::thread thread_;
};

// Nanoseconds on a processor so far, of all its threads that live.
double processor_ns(pid_t process) {
    double sum = 0.0;
    for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
        double ns = 0.0;
        std::ifstream(task.path() / "schedstat") >> ns;
        sum += ns;
    }
    return sum;
}

enum class Reader : std::uint8_t { cat, capture };

std::vector<std::string> command_of(Reader kind, const std::deque<BoardLine>& lines,
                                    const std::string& capture_path) {
    if (kind == Reader::cat) { return {"cat", lines.front().path()}; }
    std::vector<std::string> command = {gyrolog_path(), "capture", "-o", capture_path};
    for (const BoardLine& line : lines) {
        command.emplace_back("--device");
        command.push_back("tty:" + line.path());
    }
    return command;
}

template <typename Count>
double total(const std::deque<BoardLine>& lines, Count count) {
    double sum = 0.0;
    for (const BoardLine& line : lines) { sum += static_cast<double>((line.*count)()); }
    return sum;
}

void measure(benchmark::State& state, double rate_hz, double hurry, Reader kind, std::uint64_t boards = 1) {
    for ([[maybe_unused]] const auto turn : state) {
        const TemporaryFolder folder;
        std::deque<BoardLine> lines;
        for (std::uint64_t board = 1; board <= boards; ++board) {
            lines.emplace_back(rate_hz, board, hurry, kind == Reader::cat);
        }
        constexpr int new_file = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
        const int out = open(folder.path("out").c_str(), new_file, 0600);
        const int err = open(folder.path("err").c_str(), new_file, 0600);
        // What runs this in the background ignores it, and the program would keep that.
        std::signal(SIGINT, SIG_DFL);
        const pid_t reader = start_program(command_of(kind, lines, folder.path("capture.pcapng")), out, err);
        close(out);
        close(err);
        std::this_thread::sleep_for(warm_up);
        const std::int64_t begin_ns = clock_ns(CLOCK_MONOTONIC);
        const double used_before_ns = processor_ns(reader);
        const double bytes_before = total(lines, &BoardLine::bytes);
        const double samples_before = total(lines, &BoardLine::samples);
        std::this_thread::sleep_for(measured);
        const double used_ns = processor_ns(reader) - used_before_ns;
        const double elapsed_s = static_cast<double>(clock_ns(CLOCK_MONOTONIC) - begin_ns) * 1e-9;
        state.counters["cpu"] = used_ns * 1e-9 / elapsed_s;
        state.counters["ns_per_sample"] = used_ns / (total(lines, &BoardLine::samples) - samples_before);
        state.counters["bytes_per_s"] = (total(lines, &BoardLine::bytes) - bytes_before) / elapsed_s;
        state.SetIterationTime(elapsed_s);
        kill(reader, kind == Reader::cat ? SIGTERM : SIGINT);
        int status = 0;
        waitpid(reader, &status, 0);
        if (kind == Reader::capture && !(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
            state.SkipWithError(read_whole_file(folder.path("err")).c_str());
        }
    }
}

void at_the_limit(benchmark::State& state, Reader kind, std::uint64_t boards) {
    constexpr double rate_hz = 8000.0;
    measure(state, rate_hz, ceiling_bytes_per_s / bytes_per_board_second(rate_hz), kind, boards);
}
void at_1_kHz(benchmark::State& state, Reader kind) { measure(state, 1000.0, 1.0, kind); }

BENCHMARK_CAPTURE(at_the_limit, capture, Reader::capture, 1)->UseManualTime()->Iterations(1);
BENCHMARK_CAPTURE(at_the_limit, cat, Reader::cat, 1)->UseManualTime()->Iterations(1);
BENCHMARK_CAPTURE(at_the_limit, capture_of_three_boards, Reader::capture, 3)->UseManualTime()->Iterations(1);
BENCHMARK_CAPTURE(at_1_kHz, capture, Reader::capture)->UseManualTime()->Iterations(1);
BENCHMARK_CAPTURE(at_1_kHz, cat, Reader::cat)->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace gyrolog
