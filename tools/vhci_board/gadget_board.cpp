// The virtual board behind the kernel's own ACM gadget function: a USB device whose descriptors, requests and
// packets are the kernel's. The gadget itself is set up through configfs by whoever starts this program.
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/vhci_board/board_command.hpp"
#include "tools/vhci_board/tty_connection.hpp"

int main(int argc, char** argv) {
    using namespace gyrolog;
    CLI::App app{"The virtual board's bytes for a serial gadget, until Ctrl-C"};
    BoardCommand command;
    std::string tty_path = "/dev/ttyGS0";
    std::string line_state_path = "/sys/kernel/tracing/trace_pipe";
    command.declare(app);
    app.add_option("--tty", tty_path, "device side of the serial gadget")->capture_default_str();
    app.add_option("--line-state", line_state_path,
                   "trace pipe that tells the host's SET_CONTROL_LINE_STATE requests")
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    catch_stop_signals();
    SessionLog log;
    const auto run = [&]() -> Status {
        GYROLOG_TRY(const auto board, command.power_on(1, {}));
        return serve_tty_connection(*board, tty_path, line_state_path, log, stop_signal);
    };
    const Status served = run();
    const Status reported = command.report(log);
    for (const Status& status : {served, reported}) {
        if (!status.ok()) { std::cerr << "gadget_board: " << status.error().message << '\n'; }
    }
    return served.ok() && reported.ok() ? 0 : 1;
}
