// A command that takes one recording, on many of them: a line of JSON for each.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/output_paths.hpp"

namespace gyrolog {

struct ManyRecordings {
    std::vector<std::string> recordings;
    std::string jsonl_path;  // "-" is standard output; empty: not wanted
};

// The positional RECORDING... under this name and --jsonl, which excludes --json (declared before). Gives
// back the positional.
CLI::Option* add_recordings(CLI::App& app, ManyRecordings& many, const std::string& positional,
                            const std::string& help);

// The command on one recording; "" is none. As a line its JSON goes to standard output, "-".
using RunOne = std::function<ExitCode(Console&, const std::string& recording, bool as_line)>;

struct FilesOfOne {
    std::span<const NamedPath> read;     // beside each recording
    std::span<const NamedPath> written;  // by one recording: not with several
};

// Without --jsonl `run` on the one recording, or on none, as if this were not here; of several `usage`.
//
// With --jsonl on each in turn, and for each a line as it finishes, in the order of the command line:
//   {"file": as it was typed, then the keys of --json, "seconds": how long it took, "exit": where not 0}
//   {"file", "exit", "error", "command", "reported_by", "seconds"}   where there is no answer
// A recording that cannot be read costs the others nothing. What a run says on `err` stands below the name of
// its recording. A signal ends the program between two lines. The exit code is worst_of() all.
ExitCode run_on_recordings(Console& console, const char* command, const ManyRecordings& many,
                           const FilesOfOne& files, const RunOne& run);

}  // namespace gyrolog
