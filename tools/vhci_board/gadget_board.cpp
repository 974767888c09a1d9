// The virtual board behind the kernel's own ACM gadget function: a USB device whose descriptors, requests and
// packets are the kernel's. The gadget itself is set up through configfs by whoever starts this program.
#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/vhci_board/board_command.hpp"
#include "tools/vhci_board/tty_connection.hpp"

namespace gyrolog {
namespace {

int gadget_board(int argc, char** argv) {
    CLI::App app{"The virtual board's bytes for a serial gadget, until Ctrl-C", "gadget_board"};
    BoardCommand command;
    std::string tty_path = "/dev/ttyGS0";
    std::string line_state_path = "/sys/kernel/tracing/trace_pipe";
    command.declare(app);
    app.add_option("--tty", tty_path, "device side of the serial gadget")->capture_default_str();
    app.add_option("--line-state", line_state_path,
                   "trace pipe that tells the host's SET_CONTROL_LINE_STATE requests")
        ->capture_default_str();
    return run_board_command(app, argc, argv, command, [&](SessionLog& log) -> Status {
        GYROLOG_TRY(const auto board, command.power_on(1, {}));
        return serve_tty_connection(*board, tty_path, line_state_path, log, stop_signal);
    });
}

}  // namespace
}  // namespace gyrolog

int main(int argc, char** argv) {
    try {
        return gyrolog::gadget_board(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "gadget_board: " << error.what() << '\n';
        return 1;
    }
}
