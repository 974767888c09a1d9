#include "host/formats/wrapped_text.hpp"

#include "host/formats/text_width.hpp"

namespace gyrolog {

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
