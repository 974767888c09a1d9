// The virtual board as a USB device of this machine, on the kernel's virtual host controller. Needs root and
// the module vhci-hcd; then `gyrolog --device usb:` finds it like any board.
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>

#include <CLI/CLI.hpp>

#include "tools/vhci_board/board_command.hpp"
#include "tools/vhci_board/link_fault.hpp"
#include "tools/vhci_board/vhci_connection.hpp"

namespace gyrolog {
namespace {

struct Options {
    BoardCommand board;
    std::optional<unsigned> port;
    std::vector<std::string> faults;
    std::optional<double> unplug_after_s;
    std::optional<double> replug_after_s;
};

Result<std::vector<LinkFault>> parse_faults(const std::vector<std::string>& texts) {
    std::vector<LinkFault> faults;
    for (const std::string& text : texts) {
        GYROLOG_TRY(const LinkFault fault, parse_link_fault(text));
        faults.push_back(fault);
    }
    return faults;
}

// Ends early when a stop signal comes.
void wait_s(double duration_s) { ::poll(nullptr, 0, static_cast<int>(duration_s * 1e3)); }

// The board as first plugged in; after an unplugging, where that was asked for, once more and for good.
Status run(const Options& options, SessionLog& log) {
    GYROLOG_TRY(const std::vector<LinkFault> faults, parse_faults(options.faults));
    std::vector<BoardFault> unplug;
    if (options.unplug_after_s) {
        unplug.push_back({BoardFault::Kind::unplug, *options.unplug_after_s, 0.0});
    }
    GYROLOG_TRY(const auto board, options.board.power_on(1, unplug));
    GYROLOG_TRY(const ConnectionEnd end,
                serve_vhci_connection(*board, options.port, faults, log, stop_signal));
    if (end != ConnectionEnd::unplugged || !options.replug_after_s) { return {}; }

    wait_s(*options.replug_after_s);
    if (stop_signal != 0) { return {}; }
    GYROLOG_TRY(const auto again, options.board.power_on(2, {}));
    GYROLOG_CHECK(serve_vhci_connection(*again, options.port, {}, log, stop_signal));
    return {};
}

int vhci_board(int argc, char** argv) {
    CLI::App app{"The virtual board on the kernel's virtual USB host controller (vhci_hcd), until Ctrl-C",
                 "vhci_board"};
    Options options;
    options.board.declare(app);
    app.add_flag("--fixed-kind-endpoints", options.board.fixed_kind_endpoints,
                 "the endpoint numbers of controllers where the number fixes the kind");
    app.add_option("--port", options.port, "port of the controller; the first free one unless given");
    app.add_option("--fault", options.faults,
                   "stall@S, babble@S or crc@S: one bulk transfer fails S seconds after the stream's start; "
                   "repeatable")
        ->allow_extra_args(false);
    app.add_option("--unplug-after", options.unplug_after_s,
                   "pull the board out S seconds after the stream's start");
    app.add_option("--replug-after", options.replug_after_s,
                   "and plug it in again, freshly booted, S seconds later");
    return run_board_command(app, argc, argv, options.board,
                             [&](SessionLog& log) { return run(options, log); });
}

}  // namespace
}  // namespace gyrolog

int main(int argc, char** argv) {
    try {
        return gyrolog::vhci_board(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "vhci_board: " << error.what() << '\n';
        return 1;
    }
}
