// What the programs vhci_board and gadget_board have in common: options of the board, signals, the report.
#pragma once

#include <csignal>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/base/result.hpp"
#include "host/virtual_board/virtual_board.hpp"
#include "tools/vhci_board/session_log.hpp"

namespace gyrolog {

struct BoardCommand {
    std::string serial = "SIM0001";
    std::uint64_t seed = 1;
    double rate_hz = 0.0;  // 0: the firmware's default, until the host configures it
    bool fixed_kind_endpoints = false;
    std::string report_path;

    void declare(CLI::App& app);
    // Powered on. `boot` counts from 1; each boot has an id and a noise of its own.
    Result<std::unique_ptr<VirtualBoard>> power_on(std::uint32_t boot, std::vector<BoardFault> faults) const;
};

// Set once the user asks to stop, by SIGINT or SIGTERM.
extern volatile std::sig_atomic_t stop_signal;

// What a board's program does once its options are declared: parses the command line, catches the signals,
// serves the board, writes the report whatever came of it, and says on standard error what went wrong. The
// exit status.
int run_board_command(CLI::App& app, int argc, char** argv, const BoardCommand& board,
                      const std::function<Status(SessionLog&)>& serve);

}  // namespace gyrolog
