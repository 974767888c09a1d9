// Help that shows examples, and scripts that complete what there is.
#include <cstdio>
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/app/command_line.hpp"
#include "host/formats/text_width.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

std::string output_of(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_command_line(std::move(arguments), {out, err}), ExitCode::ok) << err.str();
    return out.str();
}

std::vector<std::string> all_of(const std::string& text, const char* pattern) {
    const std::regex wanted(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), wanted); match != std::sregex_iterator();
         ++match) {
        found.push_back((*match)[1]);
    }
    return found;
}

std::vector<std::string> command_names() {
    const std::string help = output_of({"--help"});
    return all_of(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
}

TEST(Help, OfEveryCommandEndsInExamplesOfItsOwnOptions) {
    const std::vector<std::string> names = command_names();
    ASSERT_GE(names.size(), 17U);
    for (const std::string& name : names) {
        const std::string help = output_of({name, "--help"});
        const std::size_t examples = help.find("Examples:");
        ASSERT_NE(examples, std::string::npos) << name;
        const std::string shown = help.substr(examples);
        EXPECT_THAT(shown, HasSubstr("gyrolog " + name)) << help;
        const std::vector<std::string> known = all_of(help.substr(0, examples), "(--[a-z0-9-]+)");
        for (const std::string& option : all_of(shown, "(--[a-z0-9-]+)")) {
            EXPECT_THAT(known, Contains(option)) << name;
        }
    }
}

TEST(Help, FitsEightyColumnsAndShowsNothingOfTheParser) {
    std::vector<std::string> names = command_names();
    names.emplace_back();  // the program's own
    for (const std::string& name : names) {
        const std::string help = output_of(name.empty() ? std::vector<std::string>{"--help"}
                                                        : std::vector<std::string>{name, "--help"});
        for (const std::string& line : all_of(help, "([^\n]*)\n")) {
            EXPECT_LE(width_of(line), 80U) << name << ": " << line;
        }
        for (const char* word : {"Excludes:", "Needs:", "REQUIRED", " TEXT", ":{", ":DIR"}) {
            EXPECT_THAT(help, Not(HasSubstr(word))) << name;
        }
    }
}

// The help of a command, without its line breaks.
std::string running_help(const char* command) {
    return std::regex_replace(output_of({command, "--help"}), std::regex("\\s+"), " ");
}

TEST(Help, SaysOfAnOptionWhatItTakesAndWhenItMayNotStand) {
    EXPECT_THAT(running_help("analyze"), HasSubstr(" --curve FILE.csv Instead of a recording"));
    EXPECT_THAT(running_help("analyze"),
                HasSubstr("one of overlapping, standard, standard_halving, modified, hadamard, "
                          "overlapping_hadamard, total; default: overlapping] --convention"));
    EXPECT_THAT(running_help("diagnose"), HasSubstr("[needs --model-out] --verbose"));
    EXPECT_THAT(running_help("capture"), HasSubstr("(.pcapng) [required]"));
    EXPECT_THAT(running_help("compare"), HasSubstr("[OPTIONS] RECORDING... WITH Positionals"));
    // What is longer than a line is still a command that one can copy.
    EXPECT_THAT(output_of({"diagnose", "--help"}),
                HasSubstr("--plot gap.png \\\n      --model-out better.json\n"));
}

// The names of options at the beginning of their entries.
std::vector<std::string> long_options_in_help(const std::string& help) {
    const std::string before_examples = help.substr(0, help.find("\nExamples:\n"));
    return all_of(before_examples, "\n  (?:-\\w,)?(--[a-z0-9-]+)");
}

TEST(ManualPage, HasEveryOptionOfItsCommandAsAnEntry) {
    std::vector<std::string> names = command_names();
    names.emplace_back();  // the program's own
    for (const std::string& name : names) {
        std::vector<std::string> page{"manual"};
        std::vector<std::string> help{"--help"};
        if (!name.empty()) {
            page.push_back(name);
            help.insert(help.begin(), name);
        }
        const std::string manual = output_of(page);
        const std::vector<std::string> options = long_options_in_help(output_of(help));
        EXPECT_GE(options.size(), 2U) << name;
        for (std::string option : options) {
            option = std::regex_replace(option, std::regex("-"), "\\-");
            const std::string bold = "\\fB" + option + "\\fR";
            const std::size_t at = manual.find(bold);
            ASSERT_NE(at, std::string::npos) << name << ' ' << option;
            const std::string entry = manual.substr(0, at);
            EXPECT_EQ(entry.rfind(".TP\n"), entry.rfind('\n', entry.size() - 1) - 3) << name << ' ' << option;
        }
        EXPECT_THAT(manual, HasSubstr(name.empty() ? ".SH NAME\ngyrolog \\- "
                                                   : ".SH NAME\ngyrolog\\-" + name + " \\- "));
        EXPECT_THAT(manual, HasSubstr(".SH EXIT STATUS\n"));
        EXPECT_THAT(manual, HasSubstr(".SH EXAMPLES\n.nf\n"));
    }
}

TEST(ManualPage, IsReadByTheFormatterWithoutAWarning) {
    if (std::system("command -v groff >/dev/null") != 0) { GTEST_SKIP() << "groff is not installed"; }
    const TemporaryFolder folder;
    const std::string page = folder.path("page.1");
    const std::string said = folder.path("said");
    for (const std::string& name : command_names()) {
        std::ofstream(page) << output_of({"manual", name});
        const std::string command = "groff -man -ww -z -Tutf8 " + page + " 2>" + said;
        EXPECT_EQ(std::system(command.c_str()), 0) << name;
        EXPECT_EQ(read_whole_file(said), "") << name;
    }
}

TEST(ManualPage, DescribesWhatACommandDoes) {
    for (const char* command : {"capture", "analyze", "simulate", "diagnose", "denoise", "calibrate",
                                "export", "compare", "table"}) {
        const std::string page = output_of({"manual", command});
        const std::size_t begin = page.find(".SH DESCRIPTION\n");
        ASSERT_NE(begin, std::string::npos) << command;
        EXPECT_GT(page.find(".SH ", begin + 1) - begin, 500U) << command;
        EXPECT_THAT(page, Not(HasSubstr("](")));
    }
}

TEST(ManualPage, OfNoCommandIsAUsageError) {
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_command_line({"manual", "frobnicate"}, {out, err}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("there is no command 'frobnicate'"));
}

// What bash offers for the last word.
std::vector<std::string> offered_by_bash(const std::string& script, const std::string& words, int last) {
    const std::string command = "bash -c '. " + script + "; COMP_WORDS=(" + words +
                                "); COMP_CWORD=" + std::to_string(last) +
                                "; _gyrolog; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
    std::vector<std::string> offered;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) { return offered; }
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
        std::string word = line.data();
        word.erase(word.find_last_not_of('\n') + 1);
        if (!word.empty()) { offered.push_back(word); }
    }
    pclose(pipe);
    return offered;
}

TEST(Completion, BashOffersCommandsOptionsAndValues) {
    const TemporaryFolder folder;
    const std::string script = folder.path("gyrolog.bash");
    std::ofstream(script) << output_of({"completion", "bash"});
    EXPECT_THAT(offered_by_bash(script, "gyrolog \"\"", 1), IsSupersetOf(command_names()));
    EXPECT_EQ(offered_by_bash(script, "gyrolog diag", 1), std::vector<std::string>{"diagnose"});
    EXPECT_THAT(offered_by_bash(script, "gyrolog diagnose --mod", 2),
                testing::ElementsAre("--model", "--model-out"));
    EXPECT_THAT(offered_by_bash(script, "gyrolog denoise --method w", 3), testing::ElementsAre("wavelet"));
    // Also where the option's own check knows more than names.
    EXPECT_THAT(offered_by_bash(script, "gyrolog export --for px4", 3),
                testing::ElementsAre("px4-classic", "px4-ekf2"));
    EXPECT_THAT(offered_by_bash(script, "gyrolog capture --full-scale \"\"", 3),
                testing::ElementsAre("250", "500", "1000", "2000"));
    EXPECT_THAT(offered_by_bash(script, "gyrolog analyze --unit d", 3),
                testing::ElementsAre("deg/s", "deg/h"));
    // And of words that are no files.
    EXPECT_THAT(offered_by_bash(script, "gyrolog completion \"\"", 2),
                testing::ElementsAre("bash", "zsh", "fish"));
    EXPECT_EQ(offered_by_bash(script, "gyrolog manual diag", 2), std::vector<std::string>{"diagnose"});
    // A file: bash's own.
    EXPECT_THAT(offered_by_bash(script, "gyrolog diagnose --model \"\"", 3), testing::IsEmpty());
    EXPECT_THAT(offered_by_bash(script, "gyrolog check \"\"", 2), testing::IsEmpty());
}

TEST(Completion, EveryShellsScriptHasEveryOption) {
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const std::string script = output_of({"completion", shell});
        for (const std::string& name : command_names()) {
            const std::string help = output_of({name, "--help"});
            EXPECT_THAT(script, HasSubstr(name)) << shell;
            for (const std::string& option :
                 all_of(help.substr(0, help.find("Examples:")), "(?:^|\n|,)  ?(--[a-z0-9-]+)")) {
                const std::string written = shell == std::string("fish") ? "-l " + option.substr(2) : option;
                EXPECT_THAT(script, HasSubstr(written)) << shell << ' ' << name;
            }
        }
    }
}

// The shells' own parsers, where they are installed.
TEST(Completion, ShellsReadTheirScripts) {
    const TemporaryFolder folder;
    int read = 0;
    for (const char* shell : {"bash", "zsh", "fish"}) {
        if (std::system((std::string("command -v ") + shell + " >/dev/null").c_str()) != 0) { continue; }
        const std::string script = folder.path(shell);
        std::ofstream(script) << output_of({"completion", shell});
        EXPECT_EQ(std::system((std::string(shell) + " -n " + script).c_str()), 0) << shell;
        ++read;
    }
    EXPECT_GE(read, 1);
}

TEST(Completion, OfAnotherShellIsAUsageError) {
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_command_line({"completion", "tcsh"}, {out, err}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("bash"));
    EXPECT_THAT(out.str(), Not(HasSubstr("complete")));
}

}  // namespace
}  // namespace gyrolog
