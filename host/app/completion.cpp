#include "host/app/completion.hpp"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/app/option_check.hpp"

namespace gyrolog {
namespace {

struct CompletedOption {
    std::string name;     // "--sensor"
    std::string summary;  // one line
    bool takes_value = false;
    std::vector<std::string> choices;  // of the value; none: a file, or whatever else
};

struct CompletedCommand {
    std::string name;
    std::string summary;
    std::vector<CompletedOption> options;
    std::vector<std::string> words;  // that stand there without an option
};

// The words in the braces of CLI11's "SENSOR:{gyro,accelerometer}".
std::vector<std::string> named_choices(const std::string& type) {
    const std::size_t open = type.find('{');
    const std::size_t close = type.find('}');
    if (open == std::string::npos || close == std::string::npos) { return {}; }
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::vector<std::string> values_of(CLI::Option& option) {
    std::vector<std::string> values = offered_values(option);
    return values.empty() ? named_choices(option.get_type_name()) : values;
}

std::vector<std::string> words_of_command(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        if (!option->get_positional()) { continue; }
        if (std::vector<std::string> values = values_of(*option); !values.empty()) { return values; }
    }
    return {};
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::vector<CompletedOption> completed_options_of(CLI::App& app) {
    std::vector<CompletedOption> options;
    for (CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            options.push_back({"--" + name, first_line(option->get_description()),
                               option->get_expected_min() > 0, values_of(*option)});
        }
    }
    return options;
}

std::vector<CompletedCommand> commands_of(CLI::App& root) {
    std::vector<CompletedCommand> commands;
    for (CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; })) {
        commands.push_back({command->get_name(), first_line(command->get_description()),
                            completed_options_of(*command), words_of_command(*command)});
    }
    return commands;
}

std::string option_names(const std::vector<CompletedOption>& options) {
    std::vector<std::string> names;
    names.reserve(options.size());
    for (const CompletedOption& option : options) { names.push_back(option.name); }
    return fmt::format("{}", fmt::join(names, " "));
}

std::string in_single_quotes(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'') {
            quoted += "'\\''";
        } else {
            quoted += c;
        }
    }
    return quoted + "'";
}

std::string bash_case(const CompletedCommand& command) {
    std::string text = fmt::format("        {})\n            case $previous in\n", command.name);
    for (const CompletedOption& option : command.options) {
        if (!option.choices.empty()) {
            text += fmt::format("                {}) words={} ;;\n", option.name,
                                in_single_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
        } else if (option.takes_value) {
            text += fmt::format("                {}) words='' ;;\n", option.name);
        }
    }
    return text + fmt::format(
                      "                *) if [[ $word == -* ]]; then words={}; else words={}; fi ;;\n"
                      "            esac ;;\n",
                      in_single_quotes(option_names(command.options)),
                      in_single_quotes(fmt::format("{}", fmt::join(command.words, " "))));
}

// What is no option is a file, which bash completes by itself.
std::string bash_script(CLI::App& root) {
    const std::vector<CompletedCommand> commands = commands_of(root);
    std::vector<std::string> names;
    std::string cases;
    for (const CompletedCommand& command : commands) {
        names.push_back(command.name);
        cases += bash_case(command);
    }
    return fmt::format(
        "# Completion of gyrolog for bash.\n_gyrolog() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words=\n"
        "    if ((COMP_CWORD == 1)); then\n        words={}\n    else\n"
        "        case ${{COMP_WORDS[1]}} in\n{}        esac\n    fi\n"
        "    COMPREPLY=()\n    local match\n"
        "    while IFS= read -r match; do COMPREPLY+=(\"$match\"); done < <(compgen -W \"$words\" -- "
        "\"$word\")\n}}\n"
        "complete -o default -F _gyrolog gyrolog\n",
        in_single_quotes(
            fmt::format("{} {}", fmt::join(names, " "), option_names(completed_options_of(root)))),
        cases);
}

// In _arguments' "--name[summary]:message:action" brackets and colons have a meaning.
std::string zsh_summary(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') { escaped += '\\'; }
        escaped += c;
    }
    return escaped;
}

std::string zsh_options(const std::vector<CompletedOption>& options) {
    std::string text;
    for (const CompletedOption& option : options) {
        std::string spec = fmt::format("{}[{}]", option.name, zsh_summary(option.summary));
        if (!option.choices.empty()) {
            spec += fmt::format(":value:({})", fmt::join(option.choices, " "));
        } else if (option.takes_value) {
            spec += ":value:_files";
        }
        text += fmt::format(" \\\n                {}", in_single_quotes(spec));
    }
    return text;
}

std::string zsh_script(CLI::App& root) {
    std::string described;
    std::string cases;
    for (const CompletedCommand& command : commands_of(root)) {
        described +=
            fmt::format("        {}\n", in_single_quotes(command.name + ":" + zsh_summary(command.summary)));
        const std::string words =
            command.words.empty() ? "_files" : fmt::format("({})", fmt::join(command.words, " "));
        cases += fmt::format("        {})\n            _arguments{} \\\n                '*:word:{}' ;;\n",
                             command.name, zsh_options(command.options), words);
    }
    return fmt::format(
        "#compdef gyrolog\n# Completion of gyrolog for zsh.\nlocal -a commands\ncommands=(\n{}    )\n"
        "if ((CURRENT == 2)); then\n    if [[ $words[2] == -* ]]; then\n        _arguments{}\n    else\n"
        "        _describe command commands\n    fi\nelse\n    local command=$words[2]\n    shift words\n"
        "    ((CURRENT--))\n    case $command in\n{}    esac\nfi\n",
        described, zsh_options(completed_options_of(root)), cases);
}

std::string fish_option(const CompletedOption& option, const std::string& condition) {
    std::string line = fmt::format("complete -c gyrolog -n {} -l {} -d {}", in_single_quotes(condition),
                                   option.name.substr(2), in_single_quotes(option.summary));
    if (option.takes_value) { line += " -r"; }
    if (!option.choices.empty()) {
        line += " -f -a " + in_single_quotes(fmt::format("{}", fmt::join(option.choices, " ")));
    }
    return line + "\n";
}

std::string fish_script(CLI::App& root) {
    std::string text = "# Completion of gyrolog for fish.\n";
    for (const CompletedOption& option : completed_options_of(root)) {
        text += fish_option(option, "__fish_use_subcommand");
    }
    for (const CompletedCommand& command : commands_of(root)) {
        text += fmt::format("complete -c gyrolog -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                            in_single_quotes(command.summary));
        const std::string condition = "__fish_seen_subcommand_from " + command.name;
        if (!command.words.empty()) {
            text += fmt::format("complete -c gyrolog -n {} -f -a {}\n", in_single_quotes(condition),
                                in_single_quotes(fmt::format("{}", fmt::join(command.words, " "))));
        }
        for (const CompletedOption& option : command.options) { text += fish_option(option, condition); }
    }
    return text;
}

}  // namespace

std::optional<std::string> completion_script(CLI::App& root, std::string_view shell) {
    if (shell == "bash") { return bash_script(root); }
    if (shell == "zsh") { return zsh_script(root); }
    if (shell == "fish") { return fish_script(root); }
    return std::nullopt;
}

}  // namespace gyrolog
