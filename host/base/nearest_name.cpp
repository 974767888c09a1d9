#include "host/base/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gyrolog {
namespace {

char small(char letter) { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter; }

// Neither is long: a word of the command line, and one of ours.
std::size_t edits_between(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> edits((a.size() + 1) * width);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return edits[i * width + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) { at(i, 0) = i; }
    for (std::size_t j = 0; j <= b.size(); ++j) { at(0, j) = j; }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = at(i - 1, j - 1) + (small(a[i - 1]) == small(b[j - 1]) ? 0 : 1);
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, changed});
            const bool swapped =
                i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]);
            if (swapped) { at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1); }
        }
    }
    return edits.back();
}

}  // namespace

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
    constexpr std::size_t longest_word = 64;
    if (word.size() > longest_word) { return {}; }
    std::string nearest;
    std::size_t fewest = word.size() / 3 + 1;
    for (const std::string& name : names) {
        const std::size_t edits = edits_between(word, name);
        if (edits < fewest) {
            fewest = edits;
            nearest = name;
        }
    }
    return nearest;
}

}  // namespace gyrolog
