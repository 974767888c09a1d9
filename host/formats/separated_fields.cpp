#include "host/formats/separated_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

namespace gyrolog {
namespace {

// Blanks in brackets part nothing, nor those before a bracket.
void split_by_blanks(std::string_view line, std::vector<std::string_view>& fields) {
    std::size_t at = 0;
    while (true) {
        while (at < line.size() && is_blank(line[at])) { ++at; }
        if (at == line.size()) { return; }
        const std::size_t begin = at;
        std::size_t end = at;
        int depth = 0;
        bool quoted = false;
        for (; at < line.size(); ++at) {
            const char c = line[at];
            if (c == '"') { quoted = !quoted; }
            if (c == '(' || c == '[') { ++depth; }
            if ((c == ')' || c == ']') && depth > 0) { --depth; }
            if (!is_blank(c)) {
                end = at + 1;
                continue;
            }
            if (depth > 0 || quoted) { continue; }
            const std::size_t next = line.find_first_not_of(" \t\r", at);
            if (next == std::string_view::npos || (line[next] != '(' && line[next] != '[')) { break; }
        }
        fields.push_back(line.substr(begin, end - begin));
    }
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) { text.remove_prefix(1); }
    while (!text.empty() && is_blank(text.back())) { text.remove_suffix(1); }
    return text;
}

std::string_view unquoted(std::string_view text) {
    text = trimmed(text);
    if (text.size() < 2 || text.front() != '"' || text.back() != '"') { return text; }
    return text.substr(1, text.size() - 2);
}

std::size_t end_of_field(std::string_view line, std::size_t begin, char separator) {
    std::size_t first = begin;
    while (first < line.size() && is_blank(line[first]) && line[first] != separator) { ++first; }
    if (first < line.size() && line[first] == '"') {
        std::size_t after = line.find('"', first + 1);
        // A doubled quotation mark stands for one in the field.
        while (after != std::string_view::npos && after + 1 < line.size() && line[after + 1] == '"') {
            after = line.find('"', after + 2);
        }
        if (after != std::string_view::npos) {
            ++after;
            while (after < line.size() && is_blank(line[after]) && line[after] != separator) { ++after; }
            if (after == line.size() || line[after] == separator) { return after; }
        }
    }
    return std::min(line.find(separator, begin), line.size());
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
    fields.clear();
    if (separator == ' ') {
        split_by_blanks(line, fields);
        return;
    }
    for (std::size_t begin = 0;;) {
        const std::size_t end = end_of_field(line, begin, separator);
        fields.push_back(line.substr(begin, end - begin));
        if (end == line.size()) { return; }
        begin = end + 1;
    }
}

char separator_of_names(std::string_view line) {
    std::array<std::size_t, 3> counts{};
    constexpr std::string_view separators = ",;\t";
    bool quoted = false;
    for (const char c : trimmed(line)) {
        if (c == '"') { quoted = !quoted; }
        const std::size_t which = separators.find(c);
        if (!quoted && which != std::string_view::npos) { ++counts[which]; }
    }
    const auto* const most = std::ranges::max_element(counts);
    if (*most > 0) { return separators[static_cast<std::size_t>(most - counts.begin())]; }
    std::vector<std::string_view> words;
    split_by_blanks(line, words);
    return words.size() > 1 ? ' ' : ',';
}

char separator_of_numbers(std::string_view line) {
    std::vector<std::string_view> fields;
    for (const char separator : {';', '\t', ',', ' '}) {
        if (separator != ' ' && line.find(separator) == std::string_view::npos) { continue; }
        split_fields(line, separator, fields);
        const bool numbers = std::ranges::all_of(
            fields, [&](std::string_view field) { return is_number_field(field, separator); });
        const bool any =
            std::ranges::any_of(fields, [](std::string_view field) { return !unquoted(field).empty(); });
        if (numbers && any) { return separator; }
    }
    return 0;
}

bool is_number_field(std::string_view field, char separator) {
    field = trimmed(unquoted(field));
    if (field.empty()) { return true; }
    std::string number(field);
    if (separator != ',') { std::ranges::replace(number, ',', '.'); }
    if (number.front() == '+') { number.erase(0, 1); }
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(number.data(), number.data() + number.size(), value);
    return problem != std::errc::invalid_argument && stop == number.data() + number.size();
}

}  // namespace gyrolog
