#include "host/app/help_text.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/formats/text_width.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t width_max = 80;
constexpr std::size_t option_column = 26;   // where descriptions of options begin
constexpr std::size_t command_column = 14;  // and those of commands

bool takes_any_number(const CLI::Option& option) {
    return option.get_expected_max() == CLI::detail::expected_max_vector_size;
}

// The parser writes behind a value's type what checks it: "FOLDER:DIR", "NAME:{gyro,accelerometer}".
std::string type_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::string name = type.substr(0, type.find(':'));
    return name == "TEXT" ? "NAME" : name;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t open = type.find(":{");
    if (open == std::string::npos) { return {}; }
    return CLI::detail::split(type.substr(open + 2, type.rfind('}') - open - 2), ',');
}

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool has_word(std::string_view text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) {
            return true;
        }
    }
    return false;
}

// Said once, by the one that excludes many.
std::set<CLI::Option*> exclusions_to_tell(const CLI::Option& option) {
    constexpr std::size_t many = 5;
    std::set<CLI::Option*> told;
    for (CLI::Option* other : option.get_excludes()) {
        if (other->get_excludes().size() < many || option.get_excludes().size() >= many) {
            told.insert(other);
        }
    }
    return told;
}

// In the order of their declaration; the parser keeps them by their addresses, which differ from run to run.
std::string names_of(const CLI::App& app, const std::set<CLI::Option*>& wanted) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        const auto is_this = [option](const CLI::Option* other) { return other == option; };
        if (std::ranges::any_of(wanted, is_this)) { names.push_back(option->get_name()); }
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

// A list's default stands in brackets.
std::string default_of(const CLI::Option& option) {
    std::string text = option.get_type_size() == 0 ? std::string() : option.get_default_str();
    if (text.size() >= 2 && text.front() == '[' && text.back() == ']') {
        text = text.substr(1, text.size() - 2);
    }
    return text;
}

std::string description_of(const CLI::App& app, const CLI::Option& option) {
    std::string text = option.get_description();
    const std::string shown =
        text + ' ' + option.get_type_name().substr(0, option.get_type_name().find(":{"));
    std::vector<std::string> notes;
    const std::vector<std::string> choices = choices_of(option);
    const auto is_shown = [&](const std::string& choice) { return has_word(shown, choice); };
    if (!std::ranges::all_of(choices, is_shown)) {
        notes.push_back(fmt::format("one of {}", fmt::join(choices, ", ")));
    }
    if (const std::string value = default_of(option); !value.empty()) {
        notes.push_back("default: " + value);
    }
    if (option.get_required() && option.nonpositional()) { notes.emplace_back("required"); }
    if (!option.get_needs().empty()) { notes.push_back("needs " + names_of(app, option.get_needs())); }
    if (const auto excluded = exclusions_to_tell(option); !excluded.empty()) {
        notes.push_back("not with " + names_of(app, excluded));
    }
    if (!notes.empty()) { text += fmt::format(" [{}]", fmt::join(notes, "; ")); }
    return text;
}

// "RECORDING...", or "RECORDING... WITH" where the last of them is another thing.
std::string word_of(const CLI::Option& option) {
    std::string word = option.get_name(true, false);
    if (takes_any_number(option)) { word += "..."; }
    if (const std::string type = option.get_type_name(); has_word(type, "WITH")) { word += " WITH"; }
    return word;
}

OptionHelp help_of(const CLI::App& app, const CLI::Option& option) {
    const std::string description = description_of(app, option);
    if (option.get_positional()) { return {{word_of(option)}, {}, description}; }
    OptionHelp help{{}, {}, description};
    for (const std::string& name : option.get_snames()) { help.names.push_back("-" + name); }
    for (const std::string& name : option.get_lnames()) { help.names.push_back("--" + name); }
    if (option.get_type_size() != 0) {
        help.value = type_of(option) + (takes_any_number(option) ? " ..." : "");
    }
    return help;
}

std::string entry(const std::string& head, const std::string& description, std::size_t column) {
    const std::string begin = "  " + head;
    if (width_of(begin) + 1 >= column) {
        return begin + '\n' + wrapped_text(std::string(column, ' '), description);
    }
    return wrapped_text(begin + std::string(column - width_of(begin), ' '), description);
}

std::string entries(const char* heading, const std::vector<OptionHelp>& options) {
    if (options.empty()) { return {}; }
    std::string text = fmt::format("\n{}:\n", heading);
    for (const OptionHelp& option : options) {
        text += entry(fmt::format("{}{}{}", fmt::join(option.names, ","), option.value.empty() ? "" : " ",
                                  option.value),
                      option.description, option_column);
    }
    return text;
}

std::string commands_in(const CLI::App& app) {
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty()) { return {}; }
    std::string text = "\nSubcommands:\n";
    for (const CLI::App* command : commands) {
        text += entry(command->get_name(), command->get_description(), command_column);
    }
    return text;
}

}  // namespace

std::vector<OptionHelp> options_of(const CLI::App& app) {
    std::vector<OptionHelp> options;
    for (const CLI::Option* option : app.get_options()) {
        if (option->nonpositional()) { options.push_back(help_of(app, *option)); }
    }
    return options;
}

std::vector<OptionHelp> words_of(const CLI::App& app) {
    std::vector<OptionHelp> words;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) { words.push_back(help_of(app, *option)); }
    }
    return words;
}

std::string usage_of(const CLI::App& app) {
    std::string text =
        app.get_parent() == nullptr ? app.get_name() : app.get_parent()->get_name() + " " + app.get_name();
    text += " [OPTIONS]";
    for (const CLI::Option* option : app.get_options()) {
        if (!option->get_positional()) { continue; }
        const std::string word = word_of(*option);
        text += option->get_required() ? " " + word : " [" + word + "]";
    }
    if (!app.get_subcommands([](const CLI::App*) { return true; }).empty()) { text += " [SUBCOMMAND]"; }
    return text;
}

std::string examples_text(std::string_view examples) {
    std::string text;
    while (!examples.empty()) {
        const std::size_t end = std::min(examples.find('\n'), examples.size());
        std::string_view line = examples.substr(0, end);
        examples.remove_prefix(std::min(end + 1, examples.size()));
        while (width_of(line) > width_max) {
            const std::size_t before_option = line.rfind(" -", width_max - 2);
            if (before_option == std::string_view::npos || before_option < 8) { break; }
            text.append(line.substr(0, before_option)).append(" \\\n     ");
            line.remove_prefix(before_option);
        }
        text.append(line) += '\n';
    }
    return text;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string /*name*/,
                                     CLI::AppFormatMode /*mode*/) const {
    const std::string footer = app->get_footer();
    return wrapped_text("", app->get_description()) + '\n' + wrapped_text("Usage: ", usage_of(*app)) +
           entries("Positionals", words_of(*app)) + entries("Options", options_of(*app)) + commands_in(*app) +
           (footer.empty() ? "" : "\n" + footer);
}

}  // namespace gyrolog
