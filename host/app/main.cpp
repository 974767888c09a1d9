#include <csignal>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <unistd.h>

#include "host/app/command_line.hpp"
#include "host/app/live_keys.hpp"
#include "host/app/program_revision.hpp"
#include "host/base/program_name.hpp"

namespace {

std::atomic<int> stop_signal = 0;

// The first signal asks for a tidy end; the same signal once more ends the program as if it had never been
// caught.
void on_stop_signal(int number) {
    stop_signal.store(number);
    gyrolog::give_terminal_back();
    static_cast<void>(std::signal(number, SIG_DFL));
}

}  // namespace

int main(int argc, char** argv) {
    static_assert(std::atomic<int>::is_always_lock_free, "the signal handler writes it");
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        action.sa_handler = on_stop_signal;
        sigaction(number, &action, nullptr);
    }
    static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
    try {
        gyrolog::set_program_revision(gyrolog::program_revision);
        const gyrolog::Console console{std::cout, std::cerr, isatty(STDERR_FILENO) == 1, &stop_signal};
        const gyrolog::ExitCode code =
            gyrolog::run_command_line(std::vector<std::string>(argv + 1, argv + argc), console);
        std::cout.flush();
        const bool lost = code == gyrolog::ExitCode::ok && !std::cout.good();
        return static_cast<int>(lost ? gyrolog::ExitCode::failed : code);
    } catch (const std::exception& error) {
        std::cerr << "gyrolog: " << error.what() << '\n';
        return static_cast<int>(gyrolog::ExitCode::failed);
    }
}
