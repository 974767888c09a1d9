// Running text on lines of a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gyrolog {

// `text` broken at spaces so that no line is longer than `width_max` characters unless a word is; the first
// line begins with `first`, which is taken to be as wide as the spaces before the others. Ends in a newline.
std::string wrapped_text(std::string_view first, std::string_view text, std::size_t width_max = 80);

}  // namespace gyrolog
