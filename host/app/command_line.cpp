#include "host/app/command_line.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <string_view>

#include "host/app/command.hpp"
#include "host/app/help_text.hpp"
#include "host/app/ink.hpp"
#include "host/base/nearest_name.hpp"
#include "host/base/printable.hpp"
#include "host/base/program_name.hpp"

namespace gyrolog {
namespace {

constexpr std::array commands{
    Command{"list", "Show the boards that are plugged in, and why one cannot be used", setup_list,
            "  gyrolog list\n"},
    Command{"capture", "Record a board's stream to a file", setup_capture,
            "  gyrolog capture --device usb: --duration 8h -o night.pcapng\n"
            "  gyrolog capture --device sim:rate=1000,seed=7 --duration 10s -o try.pcapng\n"},
    Command{"info", "Tell what is in a capture", setup_info, "  gyrolog info night.pcapng\n"},
    Command{"check", "Account for every byte, frame and sample of a capture", setup_check,
            "  gyrolog check night.pcapng --json health.json\n"},
    Command{"recover", "Save the intact part of a damaged capture", setup_recover,
            "  gyrolog recover night.pcapng -o saved.pcapng\n"},
    Command{"analyze", "Work out Allan deviation, noise coefficients and bias", setup_analyze,
            "  gyrolog analyze night.pcapng --plot night.png --model night.model.json\n"
            "  gyrolog analyze log.csv --columns t,gx,gy,gz --unit deg/s --still auto\n"},
    Command{"report", "Write one page on a recording, or on the results of many", setup_report,
            "  gyrolog report night.pcapng --model night.model.json -o night.html\n"
            "  gyrolog report analyses.jsonl gaps.jsonl -o boards.html\n"},
    Command{"compare", "Hold a recording against a model's simulations, or against another one",
            setup_compare, "  gyrolog compare day.pcapng night.model.json --plot compare.png\n"},
    Command{"calibrate", "Find scale, misalignment, bias and temperature's part from rests, turns and ramps",
            setup_calibrate,
            "  gyrolog calibrate poses.csv turns.csv --turn 360 --model-out unit.json --px4 unit.params\n"},
    Command{"conform", "Judge a board by the numbered rules of the protocol", setup_conform,
            "  gyrolog conform --device usb: --transcript board.txt\n"},
    Command{"diagnose", "Find what a model lacks: where it parts from a recording, and why", setup_diagnose,
            "  gyrolog diagnose day.pcapng --model night.model.json --plot gap.png --model-out better.json\n"
            "  gyrolog diagnose day.pcapng --auto\n"},
    Command{"denoise", "Combine an array of gyros and take noise out, sample by sample", setup_denoise,
            "  gyrolog denoise array.csv --still 0,60 -o quiet.csv --plot quiet.png\n"},
    Command{"simulate", "Make a recording of a simulated sensor", setup_simulate,
            "  gyrolog simulate night.model.json -o sim.csv --duration 12h --seed 7\n"},
    Command{"export", "Write a recording or its noise for other programs", setup_export,
            "  gyrolog export night.pcapng -o imu.yaml\n"
            "  gyrolog export night.model.json -o imu.sdf --for sdf --horizon 10m\n"},
    Command{"table", "Join the answers about many recordings into one table", setup_table,
            "  gyrolog table lines.jsonl -o fleet.csv --population boards.json\n"},
    Command{"doctor", "Tell what stands in the way on this machine, and the command that mends it",
            setup_doctor, "  gyrolog doctor\n"},
    Command{"extcap", "Answer Wireshark, which lists boards and captures from them through this",
            setup_extcap,
            "  gyrolog extcap --extcap-interfaces\n"
            "  tshark -i gyrolog-sim -c 20    # Wireshark's own way to call it\n"},
    Command{"manual", "Print the manual page of the program or of a command", setup_manual,
            "  gyrolog manual diagnose | man -l -\n"},
    Command{"completion", "Print what lets a shell complete commands and options", setup_completion,
            "  gyrolog completion bash > ~/.local/share/bash-completion/completions/gyrolog\n"},
};

constexpr const char* program_examples =
    "    gyrolog                        # the board that is plugged in, live\n"
    "    gyrolog --device sim:          # the virtual one\n"
    "    gyrolog capture --duration 8h -o night.pcapng\n"
    "    gyrolog analyze night.pcapng --plot night.png --model night.model.json\n"
    "    gyrolog diagnose day.pcapng --model night.model.json\n"
    "    gyrolog diagnose --help        # each command has examples of its own\n";

// A word that is empty is a shell's variable that was never set, and no option's absence.
std::string name_of_empty(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (std::ranges::find(option->results(), "") != option->results().end()) {
            return option->get_name();
        }
    }
    for (const CLI::App* command : app.get_subcommands()) {
        if (std::string name = name_of_empty(*command); !name.empty()) { return name; }
    }
    return {};
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
    const std::string meant = nearest_name(word, names);
    return meant.empty() ? std::string() : "; did you mean " + meant + "?";
}

// The parser's own words for a value that is missing, or is none of a few, said so that one can act on them.
std::string plain_words(const std::string& problem) {
    static const std::regex missing(": 1 required (.*?)(:DIR|:\\{.*\\})? missing$");
    static const std::regex none_of(": (.*) not in \\{(.*)\\}$");
    std::smatch found;
    if (std::regex_search(problem, found, missing)) {
        return found.prefix().str() + " wants its " + found[1].str() + " behind it";
    }
    if (std::regex_search(problem, found, none_of)) {
        const std::string names = std::regex_replace(found[2].str(), std::regex(","), ", ");
        return found.prefix().str() + ": '" + found[1].str() + "' is none of " + names;
    }
    return problem;
}

// The first of the words that the parser has left over and that looks like an option, with the one that may
// be meant. Empty: there is none.
std::string unknown_option(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) { names.push_back("--" + name); }
    }
    for (const std::string& word : app.remaining()) {
        if (word.size() < 2 || !word.starts_with('-') || word == "--") { continue; }
        const std::string given = word.substr(0, word.find('='));
        return "there is no option " + printable(given) + suggestion(given, names);
    }
    return {};
}

// A flag that is given a value, as in --quiet=yes. Empty: there is none.
std::string valued_flag(const CLI::App& app, const std::string& problem) {
    static const std::regex not_converted("^Could not convert: (--[a-z-]+) = (.*)$");
    std::smatch found;
    if (!std::regex_search(problem, found, not_converted)) { return {}; }
    const CLI::Option* option = app.get_option_no_throw(found[1].str());
    if (option == nullptr || option->get_expected_min() > 0) { return {}; }
    return found[1].str() + " takes no value, and has '" + found[2].str() + "'";
}

// What the parser complains of first may be missing only because its name is misspelt.
std::string problem_of(const CLI::App& app, const CLI::ParseError& wrong) {
    if (std::string unknown = unknown_option(app); !unknown.empty()) { return unknown; }
    if (std::string flag = valued_flag(app, wrong.what()); !flag.empty()) { return flag; }
    return plain_words(wrong.what());
}

}  // namespace

void say_warning(Console& console, const char* command, std::string_view warning) {
    console.err << Ink::warning << program_and(command) << ": warning: " << warning << Ink::plain << '\n';
}

std::vector<std::string> all_command_names() {
    std::vector<std::string> names;
    names.reserve(commands.size());
    for (const Command& command : commands) { names.emplace_back(command.name); }
    return names;
}

std::string program_and(const char* command) {
    return *command == '\0' ? "gyrolog" : std::string("gyrolog ") + command;
}

ExitCode report_error(Console& console, const char* command, const Error& error) {
    console.err << Ink::error << program_and(command) << ": " << printable(error.message) << Ink::plain
                << '\n';
    if (console.told_error != nullptr) { *console.told_error = error.message; }
    return exit_code_of(error);
}

ExitCode run_command_line(std::vector<std::string> arguments, Console console) {
    std::string called = "gyrolog";
    const auto refuse = [&](const std::string& problem) {
        console.err << Ink::error << called << ": " << problem << Ink::plain << "\nrun `" << called
                    << " --help` to see what there is\n";
        return ExitCode::usage;
    };
    if (!arguments.empty() && !arguments.front().starts_with('-')) {
        const auto is_named = [&](const Command& command) { return arguments.front() == command.name; };
        if (std::ranges::none_of(commands, is_named)) {
            return refuse("there is no command '" + arguments.front() + "'" +
                          suggestion(arguments.front(), all_command_names()));
        }
        called = program_and(arguments.front().c_str());
    }
    CLI::App app{
        "gyrolog: an inertial test bench. Without a command it finds the board, captures with a live view, "
        "and on Ctrl-C closes the file and analyses it.",
        "gyrolog"};
    app.set_version_flag("--version", program_name());
    app.require_subcommand(0, 1);
    app.formatter(std::make_shared<HelpFormatter>());
    Action action = setup_bench_session(app);
    const auto add_quiet = [&](CLI::App& to) {
        to.add_flag("-q,--quiet", console.is_quiet, "No progress and no notices; warnings and errors remain");
    };
    add_quiet(app);
    std::vector<Action> actions;
    actions.reserve(commands.size());
    for (const Command& command : commands) {
        CLI::App* sub = app.add_subcommand(command.name, command.summary);
        actions.push_back(command.setup(*sub));
        add_quiet(*sub);
        const std::string said = sub->get_footer();
        sub->footer((said.empty() ? "" : said + "\n\n") + "Examples:\n" + examples_text(command.examples));
        sub->callback([&action, &actions, i = actions.size() - 1] { action = actions[i]; });
    }
    app.footer("Examples:\n" + examples_text(program_examples));  // last: commands inherit it
    try {
        std::reverse(arguments.begin(), arguments.end());  // CLI11 takes its vector back to front
        app.parse(std::move(arguments));
    } catch (const CLI::Success& wanted) {  // --help, --version
        app.exit(wanted, console.out, console.err);
        return ExitCode::ok;
    } catch (const CLI::ParseError& wrong) {
        const std::vector<CLI::App*> chosen = app.get_subcommands();
        return refuse(problem_of(chosen.empty() ? app : *chosen.front(), wrong));
    }
    if (const std::string name = name_of_empty(app); !name.empty()) {
        return refuse(name + " is given and empty: fill it in, or leave it out");
    }
    console.progress = console.progress && !console.is_quiet;
    return action(console);
}

}  // namespace gyrolog
