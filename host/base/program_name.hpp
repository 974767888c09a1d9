// Who wrote a file or a report.
#pragma once

#include <string>

namespace gyrolog {

// "gyrolog 0.1.0"; in the program also the commit that it was built from: "gyrolog 0.1.0
// (v0.1.0-12-gabc1234)".
std::string program_name();
// What `git describe` says, or nothing. For main(), before there is another thread: nothing that links the
// libraries is built anew when the commit is another.
void set_program_revision(std::string revision);

}  // namespace gyrolog
