// The whole program behind main(): a command line in, an exit code out.
#pragma once

#include <string>
#include <vector>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"

namespace gyrolog {

// `arguments` without the program's name.
ExitCode run_command_line(std::vector<std::string> arguments, Console console);

}  // namespace gyrolog
