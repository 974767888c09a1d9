// Manual pages of the program and of each command, from the parser's own tree: what --help shows, they have.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace gyrolog {

// gyrolog(1), in the language of man(7).
std::string manual_page(const CLI::App& program);

// gyrolog-COMMAND(1).
std::string manual_page_of_command(const CLI::App& command);

}  // namespace gyrolog
