#include "host/formats/text_table.hpp"

#include <algorithm>

#include "host/formats/text_width.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t space_between = 2;

using Line = std::vector<std::string>;

std::vector<std::size_t> widths_of(const std::vector<Line>& lines) {
    std::vector<std::size_t> widths(lines.front().size());
    for (const Line& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) { widths[c] = std::max(widths[c], width_of(line[c])); }
    }
    return widths;
}

std::string part_of_table(const std::vector<Line>& lines, const std::vector<std::size_t>& widths,
                          std::size_t first, std::size_t count) {
    std::string text;
    for (const Line& line : lines) {
        std::string one(space_between, ' ');
        const auto add = [&](std::size_t c) {
            one += line[c];
            one.append(widths[c] + space_between - width_of(line[c]), ' ');
        };
        add(0);
        add(1);
        for (std::size_t c = first; c < first + count; ++c) { add(c); }
        one.resize(one.find_last_not_of(' ') + 1);
        text += one + '\n';
    }
    return text;
}

}  // namespace

std::string text_table(std::span<const std::string> heads, std::span<const TextRow> rows,
                       std::size_t width_max) {
    std::vector<Line> lines = {{"", ""}};
    lines.front().insert(lines.front().end(), heads.begin(), heads.end());
    for (const TextRow& row : rows) {
        lines.push_back({row.label, row.unit});
        lines.back().insert(lines.back().end(), row.cells.begin(), row.cells.end());
    }
    const std::vector<std::size_t> widths = widths_of(lines);
    const std::size_t labels = widths[0] + widths[1] + 3 * space_between;
    std::string text;
    for (std::size_t first = 2; first < widths.size();) {
        std::size_t count = 1;
        std::size_t width = labels + widths[first];
        while (first + count < widths.size() && width + space_between + widths[first + count] <= width_max) {
            width += space_between + widths[first + count];
            ++count;
        }
        if (!text.empty()) { text += '\n'; }
        text += part_of_table(lines, widths, first, count);
        first += count;
    }
    return text;
}

}  // namespace gyrolog
