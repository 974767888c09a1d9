// What a command would write over.
#pragma once

#include <span>
#include <string>

#include "host/base/result.hpp"

namespace gyrolog {

struct NamedPath {
    const char* option;       // "--json", "RECORDING"
    const std::string& path;  // empty: not given
};

// Nothing that is read may be written over, and nothing written twice: `invalid_argument` naming both
// options where they are the same file, by whatever path or link. Standard streams ("-") are no files.
Status check_output_paths(std::span<const NamedPath> read, std::span<const NamedPath> written);

}  // namespace gyrolog
