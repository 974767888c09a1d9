// What a command would write, and what over.
#pragma once

#include <array>
#include <span>
#include <string>

#include "host/base/result.hpp"

namespace gyrolog {

// By whatever name or link; also where it is not there yet. A stream is no file.
bool same_file(const std::string& a, const std::string& b);

struct NamedPath {
    const char* option;       // "--json", "RECORDING"
    const std::string& path;  // empty: not given
};

// Nothing that is read may be written over, and nothing written twice: `invalid_argument` naming both
// options where they are the same file, by whatever path or link. A path "-" is standard output, which only
// --json has a use for: `invalid_argument` elsewhere. Each file that shall be written is tried: not_found (no
// such directory), permission_denied, storage_failed, disk_full.
Status check_output_paths(std::span<const NamedPath> read, std::span<const NamedPath> written);

// `invalid_argument` where the name does not end as `what` does: a later reader goes by it. A pipe or a
// device may have any name.
Status check_ending(const NamedPath& written, const char* what, std::span<const char* const> endings);

inline constexpr std::array capture_endings{".pcapng"};
inline constexpr std::array page_endings{".html", ".htm"};
// Of recordings as text.
inline constexpr std::array text_endings{".csv", ".csv.gz", ".csv.xz", ".csv.zst", ".csv.bz2"};

}  // namespace gyrolog
