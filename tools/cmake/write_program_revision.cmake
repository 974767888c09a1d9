# cmake -D SOURCE=DIRECTORY -D OUTPUT=FILE -P write_program_revision.cmake
# Writes the source that holds the commit's name. A file that says the same already is left alone.

set(revision "")
find_program(GIT git)
# Only its own history: an unpacked archive may lie in somebody else's repository.
if(GIT AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --tags --match "v[0-9]*" --always --dirty
    OUTPUT_VARIABLE revision ERROR_VARIABLE problem RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT result EQUAL 0)
    message(WARNING "the program will not name its commit: ${problem}")
    set(revision "")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "host/app/program_revision.hpp"

namespace gyrolog {
const char* const program_revision = "@revision@";
}  // namespace gyrolog
]])
