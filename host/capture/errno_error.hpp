// Errors of the system calls that write a capture.
#pragma once

#include <string>

#include "host/base/result.hpp"

namespace gyrolog {

// What `errno` says: disk_full, not_found, permission_denied, invalid_argument for a file that is there
// already, else storage_failed; the message is `what`, and the system's words.
Error errno_error(const std::string& what);

}  // namespace gyrolog
