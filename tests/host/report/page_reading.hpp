// Pages read back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gyrolog::test {

inline std::vector<std::uint8_t> from_base64(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0;
    unsigned held = 0;
    for (const char character : text) {
        const std::size_t digit = digits.find(character);
        if (digit == std::string_view::npos) { break; }
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> held));
        }
    }
    return bytes;
}

// What stands between `before` and the next `after`, each time.
inline std::vector<std::string> all_between(std::string_view page, std::string_view before,
                                            std::string_view after) {
    std::vector<std::string> found;
    for (std::size_t at = page.find(before); at != std::string_view::npos; at = page.find(before, at)) {
        at += before.size();
        found.emplace_back(page.substr(at, page.find(after, at) - at));
    }
    return found;
}

// The elements that are not closed in their turn; empty for a page that is well formed.
inline std::vector<std::string> unclosed(std::string_view page) {
    std::vector<std::string> open;
    for (const std::string& tag : all_between(page, "<", ">")) {
        const std::string name = tag.substr(0, tag.find(' '));
        if (name == "!DOCTYPE" || name == "meta" || name == "br" || name == "img") { continue; }
        if (!name.starts_with('/')) {
            open.push_back(name);
        } else if (!open.empty() && open.back() == name.substr(1)) {
            open.pop_back();
        } else {
            open.push_back(name);
        }
    }
    return open;
}

}  // namespace gyrolog::test
