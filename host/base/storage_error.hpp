// Errors of the system calls that write files.
#pragma once

#include "host/base/result.hpp"

namespace gyrolog {

// What an errno says, in words that say what to do where the system's do not: disk_full (also at a limit for
// files or a quota), not_found, permission_denied, else storage_failed.
Error storage_error(int number);

}  // namespace gyrolog
