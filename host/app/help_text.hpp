// What `--help` and the manual pages say of commands and options, both made from the parser's own tree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace gyrolog {

// An option, or a word without a name, as it is shown to people.
struct OptionHelp {
    std::vector<std::string> names;  // "-o", "--output"; of a word without a name "RECORDING"
    std::string value;               // "FILE", "LIST ..."; empty: a flag
    std::string description;         // one paragraph, with choices, default and conditions at its end
};

// Of the options, or of the words without a name, in the order in which they were declared.
std::vector<OptionHelp> options_of(const CLI::App& app);
std::vector<OptionHelp> words_of(const CLI::App& app);

// "gyrolog compare [OPTIONS] RECORDING..."
std::string usage_of(const CLI::App& app);

// Commands, a line each, as one types them: what is longer than 80 characters goes on in the next line,
// behind a backslash that the shell understands.
std::string examples_text(std::string_view examples);

// Lines of at most 80 characters.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace gyrolog
