// Exit codes are interface: they differ by what the caller can do next.
#pragma once

#include "host/base/result.hpp"

namespace gyrolog {

enum class ExitCode : int {
    ok = 0,
    failed = 1,          // the operation could not be done; stderr says why
    usage = 2,           // the command line makes no sense; nothing was touched
    no_device = 3,       // no board, or no permission to use it
    device_lost = 4,     // the board went away; what came before is saved
    data_lost = 5,       // done, but samples or bytes are missing; the report counts them
    disk_full = 6,       // the file is closed and readable up to that point
    not_conforming = 7,  // the device breaks a rule of the protocol
    // 128 + n: signal n ended it before it was done, as a shell tells of it; what is written is whole
};

ExitCode ended_by_signal(int number);

// Of what was done with many things, the one code that a caller must know of: done (0), done with losses (5),
// not conforming (7), not done (1), senseless (2), no device (3), device lost (4), disk full (6), a signal;
// the worst last.
ExitCode worst_of(ExitCode a, ExitCode b);

ExitCode exit_code_of(const Error& error);
// The same while a device is being opened: one that cannot be had, for whatever reason, is "no device" to a
// script.
ExitCode exit_code_of_opening(const Error& error);

}  // namespace gyrolog
