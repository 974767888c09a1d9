// Text from outside on its way to people. Names of devices, files, columns and marks may hold anything; a
// terminal obeys some of it.
#pragma once

#include <string>
#include <string_view>

namespace gyrolog {

// In one line: control characters (line breaks and tabs among them), marks that turn the direction of text,
// and bytes that are no UTF-8 become \u001b or \x9b, as JSON and most languages write them.
std::string printable(std::string_view text);

// The same between quotation marks and cut: what a message says of something that may be of any length.
std::string in_quotes(std::string_view text);

// The same as one word of a command that a person copies into a shell: as it is, or 'between these'.
std::string shell_word(std::string_view text);

// The same for text that comes in pieces and has lines and tabs of its own, which pass.
class PrintableText {
public:
    // What of it is complete: a character may be cut at the end of a piece.
    std::string take(std::string_view piece);
    // What was still incomplete.
    std::string end();

private:
    std::string cut_;
};

}  // namespace gyrolog
