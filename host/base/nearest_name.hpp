// What somebody meant who misspelt a name.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gyrolog {

// The name that the fewest letters put in, left out, changed or swapped with their neighbour make of the word
// (Damerau 1964), where those are a third of the word at the most; empty where there is none. A small letter
// for a capital one, or the reverse, counts as none.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace gyrolog
