#include "tools/vhci_board/board_command.hpp"

#include <iostream>
#include <utility>

namespace gyrolog {

volatile std::sig_atomic_t stop_signal = 0;

void BoardCommand::declare(CLI::App& app) {
    app.add_option("--serial", serial, "serial number")->capture_default_str();
    app.add_option("--seed", seed, "of the simulated sensor's noise")->capture_default_str();
    app.add_option("--rate", rate_hz, "output rate at power-on, in Hz")->check(CLI::PositiveNumber);
    app.add_option("--report", report_path, "file for the board's own accounts, written at the end");
}

Result<std::unique_ptr<VirtualBoard>> BoardCommand::power_on(std::uint32_t boot,
                                                             std::vector<BoardFault> faults) const {
    VirtualBoardOptions options;
    options.serial = serial;
    options.seed = seed + boot - 1;
    options.rate_hz = rate_hz;
    options.boot_id = boot;
    if (fixed_kind_endpoints) { options.endpoints = gyrolog::fixed_kind_endpoints; }
    options.faults = std::move(faults);
    return VirtualBoard::create(std::move(options));
}

int run_board_command(CLI::App& app, int argc, char** argv, const BoardCommand& board,
                      const std::function<Status(SessionLog&)>& serve) {
    CLI11_PARSE(app, argc, argv);
    struct sigaction action {};
    action.sa_handler = [](int signal) { stop_signal = signal; };
    for (const int signal : {SIGINT, SIGTERM}) { sigaction(signal, &action, nullptr); }

    SessionLog log;
    const Status served = serve(log);
    Status reported;
    if (!board.report_path.empty()) {
        reported = write_report(board.report_path, board.serial, log.sessions());
    }
    for (const Status& status : {served, reported}) {
        if (!status.ok()) { std::cerr << app.get_name() << ": " << status.error().message << '\n'; }
    }
    return served.ok() && reported.ok() ? 0 : 1;
}

}  // namespace gyrolog
