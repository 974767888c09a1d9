#include "host/base/printable.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace gyrolog {
namespace {

enum class Layout { one_line, lines };

std::string hexadecimal(const char* mark, unsigned value, int digits) {
    constexpr std::string_view names = "0123456789abcdef";
    std::string text = mark;
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
        text += names[(value >> static_cast<unsigned>(shift)) & 0xFU];
    }
    return text;
}

bool is_obeyed(std::uint32_t character, Layout layout) {
    if (character == '\n' || character == '\t') { return layout == Layout::one_line; }
    const bool control = character < 0x20 || (character >= 0x7F && character < 0xA0);
    // Embeddings, overrides and isolates of direction; line and paragraph separators.
    const bool turning = (character >= 0x2028 && character <= 0x202E) ||
                         (character >= 0x2066 && character <= 0x2069) || character == 0x200E ||
                         character == 0x200F || character == 0x061C;
    return control || turning;
}

// Bytes of the character that begins with this one; 0: none does.
std::size_t length_of(std::uint8_t first) {
    if (first < 0x80) { return 1; }
    if (first >= 0xC2 && first < 0xE0) { return 2; }
    if (first >= 0xE0 && first < 0xF0) { return 3; }
    return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

bool continues(char byte) { return (static_cast<std::uint8_t>(byte) & 0xC0U) == 0x80U; }

// Nothing for bytes that are no character: overlong, a surrogate, or beyond U+10FFFF.
std::optional<std::uint32_t> character_of(std::string_view bytes) {
    constexpr std::array<std::uint32_t, 5> lowest{0, 0, 0x80, 0x800, 0x10000};
    constexpr std::array<std::uint8_t, 5> first_mask{0, 0x7F, 0x1F, 0x0F, 0x07};
    std::uint32_t value = static_cast<std::uint8_t>(bytes[0]) & first_mask[bytes.size()];
    for (const char byte : bytes.substr(1)) {
        value = value << 6U | (static_cast<std::uint8_t>(byte) & 0x3FU);
    }
    const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
    if (value < lowest[bytes.size()] || surrogate || value > 0x10FFFF) { return std::nullopt; }
    return value;
}

void append_bytes(std::string& to, std::string_view bytes) {
    for (const char byte : bytes) { to += hexadecimal("\\x", static_cast<std::uint8_t>(byte), 2); }
}

// Appends what is whole, and returns how much of `text` that was: less than all where a character is cut.
std::size_t append_printable(std::string& to, std::string_view text, Layout layout) {
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t length = length_of(static_cast<std::uint8_t>(text[at]));
        std::size_t there = 1;
        while (there < length && at + there < text.size() && continues(text[at + there])) { ++there; }
        if (there < length && at + there == text.size()) { return at; }
        const std::string_view bytes = text.substr(at, there);
        const auto character = there == length ? character_of(bytes) : std::nullopt;
        if (!character) {
            append_bytes(to, bytes);
        } else if (is_obeyed(*character, layout)) {
            to += hexadecimal("\\u", *character, 4);
        } else {
            to += bytes;
        }
        at += there;
    }
    return at;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string shown;
    const std::size_t whole = append_printable(shown, text, Layout::one_line);
    append_bytes(shown, text.substr(whole));
    return shown;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t bytes_most = 80;
    return "'" + printable(text.substr(0, bytes_most)) + (text.size() > bytes_most ? "...'" : "'");
}

std::string shell_word(std::string_view text) {
    std::string shown = printable(text);
    constexpr std::string_view plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:=,+@%-";
    if (!shown.empty() && shown.find_first_not_of(plain) == std::string::npos) { return shown; }
    std::string word = "'";
    for (const char c : shown) { c == '\'' ? word += "'\\''" : word += c; }
    return word + "'";
}

std::string PrintableText::take(std::string_view piece) {
    cut_ += piece;
    std::string shown;
    cut_.erase(0, append_printable(shown, cut_, Layout::lines));
    return shown;
}

std::string PrintableText::end() {
    std::string shown;
    append_bytes(shown, cut_);
    cut_.clear();
    return shown;
}

}  // namespace gyrolog
