// The rule that opens the boards to their users (tools/60-gyrolog.rules), in the program itself.
#pragma once

namespace gyrolog {

extern const char* const udev_rule_text;

}  // namespace gyrolog
