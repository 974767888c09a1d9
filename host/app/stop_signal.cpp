#include "host/app/stop_signal.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <span>

#include "host/app/live_keys.hpp"
#include "host/base/unfinished_files.hpp"
#include "host/transport/raw_port.hpp"

namespace gyrolog {
namespace {

std::atomic<int> noted = 0;
std::atomic<std::int64_t> noted_ns = 0;
std::atomic<int> tidy_ends = 0;

static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "signal handlers write it");

// The signal comes again when its handler returns, and finds nobody who catches it.
void end_by(int number) {
    static_cast<void>(std::signal(number, SIG_DFL));
    static_cast<void>(std::raise(number));
}

std::int64_t clock_ns() {
    struct timespec now {};
    static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &now));
    return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

// `timeout` signals the process, then its group, the process among it, within microseconds. That is one
// wish. Nobody presses Ctrl-C twice as quickly.
bool is_twin(int number) {
    constexpr std::int64_t twins_within_ns = 200'000'000;
    return noted.load() == number && clock_ns() - noted_ns.load() < twins_within_ns;
}

void on_stop_signal(int number) {
    give_terminal_back();
    if (is_twin(number)) { return; }
    int none = 0;
    if (tidy_ends.load() > 0) {
        noted_ns.store(clock_ns());
        if (noted.compare_exchange_strong(none, number)) { return; }
    }
    remove_unfinished_files();
    restore_ports();
    end_by(number);
}

void on_crash(int number) {
    give_terminal_back();
    remove_unfinished_files();
    restore_ports();
    end_by(number);
}

// By signal(7), of all signals: what does not end a process, or cannot be caught.
constexpr std::array harmless{SIGCHLD, SIGCONT, SIGURG,  SIGWINCH, SIGTSTP,
                              SIGTTIN, SIGTTOU, SIGSTOP, SIGKILL};
constexpr std::array crashes{SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS};
// A pipe that nobody reads and a file at its limit (ulimit -f) are errors of the write.
constexpr std::array errors_of_writes{SIGPIPE, SIGXFSZ};

bool is_one_of(std::span<const int> numbers, int number) {
    return std::ranges::find(numbers, number) != numbers.end();
}

void install(int number, void (*handler)(int)) {
    struct sigaction before {};
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) { return; }
    struct sigaction action {};
    action.sa_handler = handler;
    sigaction(number, &action, nullptr);
}

}  // namespace

void install_stop_signals() {
    for (const int number : crashes) {
        // A sanitizer tells of a crash in its own handler.
        struct sigaction before {};
        if (sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_DFL) {
            install(number, on_crash);
        }
    }
    for (const int number : errors_of_writes) { static_cast<void>(std::signal(number, SIG_IGN)); }
    // All others that end a process, the real-time ones too: they are sent by limits of processor time,
    // timers, power supplies, and people who take them for a question. The C library keeps some, and refuses
    // them.
    for (int number = 1; number <= SIGRTMAX; ++number) {
        if (!is_one_of(harmless, number) && !is_one_of(crashes, number) &&
            !is_one_of(errors_of_writes, number)) {
            install(number, on_stop_signal);
        }
    }
}

TidyEnd::TidyEnd() { ++tidy_ends; }
TidyEnd::~TidyEnd() { --tidy_ends; }

const std::atomic<int>& noted_stop_signal() { return noted; }

}  // namespace gyrolog
