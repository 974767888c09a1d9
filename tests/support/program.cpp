#include "tests/support/program.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/clock.hpp"
#include "tests/support/schema_check.hpp"

namespace gyrolog {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds time_limit(240);  // for a day of samples beside other work

struct SignalPlan {
    std::chrono::milliseconds after;
    int number;
    std::string once_there;             // counts from when this file exists; empty: from the start
    std::chrono::milliseconds held{0};  // SIGCONT follows after so long; 0: none
    FileState state = FileState::is_there;
};

std::array<int, 2> make_pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) { throw std::runtime_error("pipe failed"); }
    return ends;
}

bool is_in_state(const std::filesystem::path& path, FileState state) {
    const auto is_so = [&](const std::filesystem::path& file) {
        std::error_code none;
        const std::uintmax_t bytes = std::filesystem::file_size(file, none);
        return !none && (state == FileState::is_there || bytes > 0);
    };
    if (std::filesystem::exists(path)) { return is_so(path); }
    const std::filesystem::directory_iterator folder(path.parent_path());
    return std::any_of(begin(folder), end(folder), [&](const std::filesystem::directory_entry& entry) {
        const std::string name = entry.path().filename();
        return name.starts_with(path.filename().string() + '.') && name.ends_with(".part") &&
               is_so(entry.path());
    });
}

// Reads both pipes to their ends, sending the signal on the way.
void collect(pid_t child, int out, int err, std::optional<SignalPlan> plan, ProgramResult& result) {
    const auto start = Clock::now();
    auto counted_from = start;
    std::array<pollfd, 2> ends{{{out, POLLIN, 0}, {err, POLLIN, 0}}};
    std::array<std::string*, 2> texts{&result.out, &result.err};
    std::size_t open_ends = ends.size();
    while (open_ends > 0) {
        if (poll(ends.data(), ends.size(), 20) < 0 && errno != EINTR) { break; }
        if (plan && !plan->once_there.empty() && is_in_state(plan->once_there, plan->state)) {
            plan->once_there.clear();
            counted_from = Clock::now();
        }
        if (plan && plan->once_there.empty() && Clock::now() - counted_from >= plan->after) {
            result.signalled_ns = host_now().monotonic_ns;
            kill(child, plan->number);
            const std::chrono::milliseconds held = plan->held;
            plan.reset();
            if (held.count() > 0) {
                plan = SignalPlan{held, SIGCONT, "", {}};
                counted_from = Clock::now();
            }
        }
        if (Clock::now() - start > time_limit) {
            kill(child, SIGKILL);
            result.err += "\n(killed by the test: it did not end)\n";
        }
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if ((ends[i].revents & (POLLIN | POLLHUP)) == 0) { continue; }
            std::array<char, 65536> piece{};
            const ssize_t size = read(ends[i].fd, piece.data(), piece.size());
            if (size > 0) {
                texts[i]->append(piece.data(), static_cast<std::size_t>(size));
            } else {
                ends[i].fd = -1;
                --open_ends;
            }
        }
    }
}

ProgramResult run(const std::vector<std::string>& arguments, std::optional<SignalPlan> plan) {
    const auto out = make_pipe();
    const auto err = make_pipe();
    std::vector<std::string> command = {gyrolog_path()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const pid_t child = start_program(command, out[1], err[1]);
    close(out[1]);
    close(err[1]);
    ProgramResult result;
    collect(child, out[0], err[0], plan, result);
    close(out[0]);
    close(err[0]);
    int status = 0;
    waitpid(child, &status, 0);
    result.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    expect_schemas_kept(result.out, "standard output");
    return result;
}

}  // namespace

std::string gyrolog_path() {
    const char* build = std::getenv("GYROLOG_BUILD_DIR");
    const std::filesystem::path folder =
        build == nullptr ? std::filesystem::read_symlink("/proc/self/exe").parent_path() : build;
    return (folder / "gyrolog").string();
}

pid_t start_program(const std::vector<std::string>& command, int out, int err) {
    std::vector<char*> argv;
    argv.reserve(command.size() + 1);
    for (const std::string& word : command) { argv.push_back(const_cast<char*>(word.c_str())); }
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) { throw std::runtime_error("fork failed"); }
    if (child == 0) {
        const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
        dup2(nothing, STDIN_FILENO);
        dup2(out < 0 ? nothing : out, STDOUT_FILENO);
        dup2(err < 0 ? nothing : err, STDERR_FILENO);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    return child;
}

ProgramResult run_gyrolog(const std::vector<std::string>& arguments) { return run(arguments, std::nullopt); }

ProgramResult run_gyrolog_and_signal(const std::vector<std::string>& arguments,
                                     std::chrono::milliseconds after, int signal,
                                     const std::string& once_there, FileState state) {
    return run(arguments, SignalPlan{after, signal, once_there, {}, state});
}

ProgramResult run_gyrolog_and_hold(const std::vector<std::string>& arguments, std::chrono::milliseconds after,
                                   std::chrono::milliseconds held) {
    return run(arguments, SignalPlan{after, SIGSTOP, "", held});
}

std::string read_whole_file(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

TemporaryFolder::TemporaryFolder(Documents documents) : documents_(documents) {
    std::string name = (std::filesystem::temp_directory_path() / "gyrolog_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) { throw std::runtime_error("no temporary folder"); }
    folder_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    if (documents_ == Documents::keep_schemas) { expect_schemas_kept_in(folder_); }
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

}  // namespace gyrolog
