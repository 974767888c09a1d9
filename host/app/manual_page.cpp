#include "host/app/manual_page.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/app/help_text.hpp"
#include "host/app/manual_text.hpp"
#include "host/base/program_name.hpp"

namespace gyrolog {
namespace {

// A hyphen as one types it, and nothing that the formatter takes for a request of its own.
std::string escaped(std::string_view text) {
    std::string page;
    bool at_line_start = true;
    for (const char c : text) {
        if (at_line_start && (c == '.' || c == '\'')) { page += "\\&"; }
        switch (c) {
            case '-':
                page += "\\-";
                break;
            case '\\':
                page += "\\e";
                break;
            case '\'':
                page += "\\(aq";
                break;
            case '`':
                page += "\\(ga";
                break;
            case '^':
                page += "\\(ha";
                break;
            case '~':
                page += "\\(ti";
                break;
            default:
                page += c;
        }
        at_line_start = c == '\n';
    }
    return page;
}

std::string man_entry(const OptionHelp& option) {
    std::vector<std::string> names;
    names.reserve(option.names.size());
    for (const std::string& name : option.names) { names.push_back("\\fB" + escaped(name) + "\\fR"); }
    const std::string value = option.value.empty() ? "" : " \\fI" + escaped(option.value) + "\\fR";
    return fmt::format(".TP\n{}{}\n{}\n", fmt::join(names, ", "), value, escaped(option.description));
}

std::string man_entries(const char* heading, const std::vector<OptionHelp>& options) {
    if (options.empty()) { return {}; }
    std::string text = fmt::format(".SH {}\n", heading);
    for (const OptionHelp& option : options) { text += man_entry(option); }
    return text;
}

std::string head(const std::string& name, const std::string& summary) {
    std::string title = name;
    for (char& c : title) { c = static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }
    return fmt::format(".TH {} 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", escaped(title),
                       program_name().substr(0, program_name().find(" (")), escaped(name), escaped(summary));
}

// "gyrolog compare [OPTIONS] RECORDING... WITH", with the words that are typed as they are in bold.
std::string synopsis(const CLI::App& app) {
    const std::string usage = usage_of(app);
    const std::size_t end = usage.find(" [");
    return fmt::format(".SH SYNOPSIS\n.B {}\n{}\n", escaped(usage.substr(0, end)),
                       escaped(usage.substr(end + 1)));
}

// "Examples:" begins the part of the footer that is shown as it is; before it stands running text.
std::string footer_of(const CLI::App& app) {
    const std::string footer = app.get_footer();
    const std::string heading = "Examples:\n";
    const std::size_t examples = footer.find(heading);
    std::string text;
    const std::string said = footer.substr(0, examples);
    if (const std::size_t last = said.find_last_not_of('\n'); last != std::string::npos) {
        text += ".SH NOTES\n" + escaped(said.substr(0, last + 1)) + '\n';
    }
    if (examples != std::string::npos) {
        text += ".SH EXAMPLES\n.nf\n" + escaped(footer.substr(examples + heading.size())) + ".fi\n";
    }
    return text;
}

std::string paragraph(std::string_view text) {
    if (text.starts_with("  ")) { return ".PP\n.nf\n" + escaped(text) + "\n.fi\n"; }
    if (text.starts_with("- ")) { return ".IP \\- 2\n" + escaped(text.substr(2)) + '\n'; }
    return ".PP\n" + escaped(text) + '\n';
}

std::string paragraphs_of(std::string_view text) {
    std::string page;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find("\n\n"), text.size());
        page += paragraph(text.substr(0, end));
        text.remove_prefix(std::min(end + 2, text.size()));
    }
    return page;
}

std::string description_of_command(const CLI::App& command) {
    const std::string text = paragraphs_of(manual_text(command.get_name()));
    return text.empty() ? "" : ".SH DESCRIPTION\n" + text;
}

constexpr const char* exit_status =
    ".SH EXIT STATUS\n"
    "0 ok, 1 failed, 2 usage, 3 no device or no permission, 4 device lost (what came before is saved), 5 "
    "done but\n"
    "data were lost, 6 disk full, 7 does not conform.\n";

constexpr const char* examples =
    ".SH EXAMPLES\n"
    ".nf\n"
    "gyrolog capture \\-\\-device sim:rate=100,seed=1 \\-\\-duration 6h \\-o night.pcapng\n"
    "gyrolog check night.pcapng\n"
    "gyrolog analyze night.pcapng \\-\\-json night.json \\-\\-plot night.png\n"
    ".fi\n";

constexpr const char* files =
    ".SH FILES\n"
    ".TP\n"
    ".I /usr/lib/udev/rules.d/60\\-gyrolog.rules\n"
    "gives access to a board that is plugged in afterwards: to whoever sits at the machine, and to the group "
    "plugdev\n"
    "(its serial port: dialout)\n"
    ".TP\n"
    ".I /usr/lib/*/wireshark/plugins/gyrolog.lua\n"
    "dissector of the protocol, which Wireshark and tshark load by themselves\n"
    ".TP\n"
    ".I /usr/lib/*/wireshark/extcap/gyrolog\n"
    "lets Wireshark capture from boards\n"
    ".TP\n"
    ".I /usr/share/gyrolog/schemas\n"
    "JSON Schemas (draft 7) of all that is written with\n"
    ".B \\-\\-json\n"
    "and\n"
    ".BR \\-\\-jsonl ,\n"
    "and of the files that are read: gyrolog\\-model/1 is described by gyrolog\\-model\\-1.schema.json\n"
    ".TP\n"
    ".I /usr/share/doc/gyrolog\n"
    "what each command does (README.md), the estimators (analysis/METHODS.md), the protocol\n"
    "(firmware_protocol/SPEC.md), the file (host/capture/FORMAT.md), a fitted gyro in other simulators "
    "(examples)\n";

}  // namespace

std::string manual_page(const CLI::App& program) {
    std::string commands = ".SH COMMANDS\nEach has a page of its own, gyrolog\\-COMMAND(1).\n";
    std::vector<std::string> pages;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
        const std::string name = command->get_name();
        commands += fmt::format(".TP\n.B {}\n{}.\n", name, escaped(command->get_description()));
        pages.push_back(fmt::format(".BR gyrolog\\-{} (1)", name));
    }
    return head("gyrolog", "capture, analyse and simulate inertial sensors") +
           ".SH SYNOPSIS\n.B gyrolog\n[OPTIONS]\n.br\n.B gyrolog\n.I COMMAND\n[OPTIONS]\n.SH DESCRIPTION\n" +
           escaped(program.get_description()) + '\n' + paragraphs_of(manual_text("")) + commands +
           man_entries("OPTIONS", options_of(program)) + exit_status + examples + files +
           fmt::format(".SH SEE ALSO\n{}\n", fmt::join(pages, ",\n"));
}

std::string manual_page_of_command(const CLI::App& command) {
    return head("gyrolog-" + command.get_name(), command.get_description()) + synopsis(command) +
           description_of_command(command) + man_entries("ARGUMENTS", words_of(command)) +
           man_entries("OPTIONS", options_of(command)) + exit_status + footer_of(command) +
           ".SH SEE ALSO\n.BR gyrolog (1)\n";
}

}  // namespace gyrolog
