#include "host/formats/cause_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <string_view>

#include "host/formats/text_width.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t table_width = 80;
constexpr std::size_t space_between = 2;
constexpr std::size_t columns = 5;
constexpr std::size_t size_column = 2;
constexpr std::size_t least_size_width = 16;

// One line of a row: the cause, its axes, its size, its share, its probability.
using Line = std::array<std::string, columns>;
using Row = std::vector<Line>;

// All but the first indented.
std::vector<std::string> lines_of(const std::string& text, std::size_t width) {
    constexpr std::string_view indent = "  ";
    std::istringstream wrapped(wrapped_text(indent, text, width));
    std::vector<std::string> lines;
    for (std::string line; std::getline(wrapped, line);) { lines.push_back(line); }
    lines.front().erase(0, indent.size());
    return lines;
}

// As if every value had one line.
Row row_of(const DiagnosisSentences::OfCause& cause, std::size_t number) {
    Row row;
    for (const CauseSize& size : cause.sizes) {
        row.push_back({"", size.axes, size.values.empty() ? "" : size.values.front(), "", ""});
        for (std::size_t i = 1; i < size.values.size(); ++i) {
            row.push_back({"", "", size.values[i], "", ""});
        }
    }
    if (row.empty()) { row.emplace_back(); }
    Line& first = row.front();
    first[0] = std::to_string(number) + ". " + cause.effect;
    first[3] = cause.share;
    first[4] = cause.probability;
    return row;
}

// With sizes that are wider than that on several lines.
Row wrapped(const Row& row, std::size_t size_width) {
    Row lines;
    for (const Line& line : row) {
        const std::vector<std::string> sizes = lines_of(line[size_column], size_width);
        lines.push_back(line);
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            if (i > 0) { lines.emplace_back(); }
            lines.back()[size_column] = sizes[i];
        }
    }
    return lines;
}

std::array<std::size_t, columns> widths_of(const std::vector<Row>& rows) {
    std::array<std::size_t, columns> widths{};
    for (const Row& row : rows) {
        for (const Line& line : row) {
            for (std::size_t c = 0; c < columns; ++c) { widths[c] = std::max(widths[c], width_of(line[c])); }
        }
    }
    return widths;
}

std::string text_of(const Line& line, const std::array<std::size_t, columns>& widths) {
    std::string text;
    for (std::size_t c = 0; c < columns; ++c) {
        text.append(space_between, ' ').append(line[c]).append(widths[c] - width_of(line[c]), ' ');
    }
    text.resize(text.find_last_not_of(' ') + 1);
    return text + '\n';
}

}  // namespace

std::string cause_table(const std::vector<DiagnosisSentences::OfCause>& causes) {
    std::vector<Row> rows{{{"   cause", "axes", "size", "share of gap", "probability"}}};
    for (std::size_t i = 0; i < causes.size(); ++i) { rows.push_back(row_of(causes[i], i + 1)); }
    std::array<std::size_t, columns> widths = widths_of(rows);
    std::size_t others = space_between * columns;
    for (std::size_t c = 0; c < columns; ++c) { others += c == size_column ? 0 : widths[c]; }
    const std::size_t left = table_width > others ? table_width - others : 0;
    const std::size_t size_width = std::max(left, least_size_width);
    for (Row& row : rows) { row = wrapped(row, size_width); }
    widths = widths_of(rows);
    std::string text;
    for (const Row& row : rows) {
        for (const Line& line : row) { text += text_of(line, widths); }
    }
    return text;
}

}  // namespace gyrolog
