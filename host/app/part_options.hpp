// --from, --to and --still: the part of a recording that a command looks at.
#pragma once

#include <CLI/CLI.hpp>

#include "host/app/part_choice.hpp"

namespace gyrolog {

// `part` outlives the parsing.
void add_part_options(CLI::App& app, PartChoice& part);
// Without --still.
void add_time_options(CLI::App& app, PartChoice& part);

}  // namespace gyrolog
