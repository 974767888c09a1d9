// Several boards captured at once, each to a file of its own.
#pragma once

#include <string>
#include <vector>

#include "host/app/capture_options.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"

namespace gyrolog {

// `path` is what the files are named after (path_of_board). Opens every device before the first one starts,
// so that none is captured without the others. The exit code is the gravest of the boards'.
ExitCode capture_boards(Console& console, const char* command, const CaptureOptions& options,
                        const std::vector<std::string>& devices, const std::string& path);

}  // namespace gyrolog
