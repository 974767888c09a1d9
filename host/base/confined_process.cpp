#include "host/base/confined_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gyrolog {
namespace {

// The whole address space: sanitizers and libraries reserve much of it that they never use.
std::size_t reserved_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t pages = 0;
    statm >> pages;
    return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int what, rlim_t to) {
    const struct rlimit both { to, to };
    static_cast<void>(::setrlimit(static_cast<__rlimit_resource>(what), &both));
}

// The handlers of the program tidy up what is the parent's.
void forget_handlers() {
    for (int number = 1; number < SIGRTMIN; ++number) { static_cast<void>(std::signal(number, SIG_DFL)); }
}

[[noreturn]] void be_child(const ProcessConfines& confines, std::size_t address_space_bytes, int result,
                           const std::function<void(int)>& work) {
    static_cast<void>(::prctl(PR_SET_PDEATHSIG, SIGKILL));
    forget_handlers();
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        static_cast<void>(::dup2(nowhere, standard));
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_AS, address_space_bytes);
    limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(confines.processor_s)));
    try {
        work(result);
    } catch (...) { ::_exit(1); }
    ::_exit(0);
}

// What comes until the end, as much as is allowed.
Bytes all_from(int descriptor, std::size_t most) {
    Bytes all;
    std::array<std::uint8_t, 65536> piece{};
    while (all.size() <= most) {
        const ssize_t got = ::read(descriptor, piece.data(), piece.size());
        if (got < 0 && errno == EINTR) { continue; }
        if (got <= 0) { break; }
        all.insert(all.end(), piece.begin(), piece.begin() + got);
    }
    return all;
}

}  // namespace

Result<Bytes> run_confined(const ProcessConfines& confines, const std::function<void(int descriptor)>& work) {
    const std::size_t address_space_bytes = reserved_bytes() + confines.memory_bytes;
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return Error{ErrorCode::failed, std::string("no pipe: ") + std::strerror(errno)};
    }
    const pid_t child = ::fork();
    if (child == 0) { be_child(confines, address_space_bytes, ends[1], work); }
    const int problem = errno;
    static_cast<void>(::close(ends[1]));
    if (child < 0) {
        static_cast<void>(::close(ends[0]));
        return Error{ErrorCode::failed, std::string("no process: ") + std::strerror(problem)};
    }
    Bytes result = all_from(ends[0], confines.result_bytes);
    static_cast<void>(::close(ends[0]));
    if (result.size() > confines.result_bytes) { static_cast<void>(::kill(child, SIGKILL)); }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (result.size() > confines.result_bytes) { return malformed("it holds more than its size allows"); }
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
        return malformed("reading it takes more time than its size allows");
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return malformed(
            "the library that reads it failed: it is damaged, or asks for more memory than its size "
            "allows");
    }
    return result;
}

}  // namespace gyrolog
