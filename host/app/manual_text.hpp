// What the manual pages say beside the options: how a command works, what it takes and what it gives.
#pragma once

#include <string_view>

namespace gyrolog {

// Of a command, or with "" of the program; empty where the options say all. Paragraphs with a blank line
// between them; lines that begin with two blanks stand as they are, and a paragraph that begins with "- " is
// an item of a list.
std::string_view manual_text(std::string_view command);

}  // namespace gyrolog
