// Scripts by which shells complete the command line: made from the commands and options that there are.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace gyrolog {

// `root` has all commands. A shell that is none of bash, zsh and fish has no script.
std::optional<std::string> completion_script(CLI::App& root, std::string_view shell);

}  // namespace gyrolog
