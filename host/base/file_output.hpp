// A result file, written whole or not at all.
#pragma once

#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Replaces the file at `path` by `contents`, as ReplacingFile does. Errors: storage_failed, disk_full,
// not_found (the folder is missing), permission_denied.
Status write_file(const std::string& path, ByteView contents);

}  // namespace gyrolog
