#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "host/app/command_line.hpp"
#include "host/app/printable_stream.hpp"
#include "host/app/program_revision.hpp"
#include "host/app/standard_output.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/program_name.hpp"

namespace {

// A standard stream that was closed by who started the program: without this the next file that is opened, a
// capture perhaps, would get its number and its text. Reading and writing it remain errors.
void occupy_closed_streams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(descriptor, F_GETFD) != -1) { continue; }
        const int occupied = open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        if (occupied != descriptor && occupied >= 0) { close(occupied); }
    }
}

}  // namespace

int main(int argc, char** argv) {
    occupy_closed_streams();
    gyrolog::install_stop_signals();
    try {
        gyrolog::set_program_revision(gyrolog::program_revision);
        gyrolog::StandardOutput output;
        gyrolog::PrintableStream messages(std::cerr, gyrolog::takes_colour(STDERR_FILENO));
        const gyrolog::Console console{output, messages, isatty(STDERR_FILENO) == 1,
                                       &gyrolog::noted_stop_signal(), &std::cerr};
        const gyrolog::ExitCode code =
            gyrolog::run_command_line(std::vector<std::string>(argv + 1, argv + argc), console);
        const gyrolog::Status told = output.finish();
        if (told.ok()) { return static_cast<int>(code); }
        std::cerr << "gyrolog: " << told.error().message << '\n';
        const bool graver = code != gyrolog::ExitCode::ok;
        return static_cast<int>(graver ? code : gyrolog::exit_code_of(told.error()));
    } catch (const std::exception& error) {
        std::cerr << "gyrolog: " << gyrolog::printable(error.what()) << '\n';
        return static_cast<int>(gyrolog::ExitCode::failed);
    }
}
