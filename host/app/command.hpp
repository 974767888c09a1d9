// A command of the program: one file each, one line in command_line.cpp.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// What a parsed command line is to do.
using Action = std::function<ExitCode(Console&)>;

// Declares a command's options on `app` and returns what to do once they are parsed.
using CommandSetup = Action (*)(CLI::App& app);

struct Command {
    const char* name;
    const char* summary;
    CommandSetup setup;
    const char* examples;  // lines, as one types them
};

// Each in its command_NAME.cpp.
Action setup_analyze(CLI::App& app);
Action setup_calibrate(CLI::App& app);
Action setup_capture(CLI::App& app);
Action setup_check(CLI::App& app);
Action setup_compare(CLI::App& app);
Action setup_completion(CLI::App& app);
Action setup_conform(CLI::App& app);
Action setup_denoise(CLI::App& app);
Action setup_diagnose(CLI::App& app);
Action setup_doctor(CLI::App& app);
Action setup_export(CLI::App& app);
Action setup_extcap(CLI::App& app);
Action setup_info(CLI::App& app);
Action setup_list(CLI::App& app);
Action setup_manual(CLI::App& app);
Action setup_recover(CLI::App& app);
Action setup_report(CLI::App& app);
Action setup_simulate(CLI::App& app);
Action setup_table(CLI::App& app);
// The program without a command: find the board, capture, analyse.
Action setup_bench_session(CLI::App& app);

// Of all commands, in the order in which the help lists them.
std::vector<std::string> all_command_names();

// "gyrolog NAME", or "gyrolog" for the program without a command.
std::string program_and(const char* command);

// "gyrolog NAME: message" on err, and the exit code that goes with the error.
ExitCode report_error(Console& console, const char* command, const Error& error);

// "gyrolog NAME: warning: ..." on err.
void say_warning(Console& console, const char* command, std::string_view warning);

}  // namespace gyrolog
