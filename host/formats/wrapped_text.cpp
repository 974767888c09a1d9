#include "host/formats/wrapped_text.hpp"

#include <algorithm>

namespace gyrolog {
namespace {

// Characters of UTF-8.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(
        text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) != 0x80U; }));
}

}  // namespace

std::string wrapped_text(std::string_view first, std::string_view text, std::size_t width_max) {
    const std::size_t indent = width_of(first);
    std::string wrapped(first);
    std::size_t column = indent;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (word.empty()) { continue; }
        const std::size_t width = width_of(word);
        if (column > indent && column + 1 + width > width_max) {
            wrapped.append(1, '\n').append(indent, ' ');
            column = indent;
        } else if (column > indent) {
            wrapped += ' ';
            ++column;
        }
        wrapped += word;
        column += width;
    }
    return wrapped + '\n';
}

}  // namespace gyrolog
