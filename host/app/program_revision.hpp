// The commit that the program is built from. Its source is written by
// tools/cmake/write_program_revision.cmake.
#pragma once

namespace gyrolog {

// As `git describe --tags --always --dirty` has it; "" for a source without its history.
extern const char* const program_revision;

}  // namespace gyrolog
