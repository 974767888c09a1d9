#include "host/formats/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) { text.remove_prefix(1); }
    while (!text.empty() && is_blank(text.back())) { text.remove_suffix(1); }
    return text;
}

// A byte that no text holds, as file(1) has it: control characters but for BEL to CR and ESC. 0 is judged
// with the header.
bool is_binary(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte > 0 && byte < 7) || (byte > 13 && byte < 32 && byte != 27) || byte == 127;
}

// What looks like another kind of file has no columns whose names would help anybody.
Status check_kind(std::string_view header) {
    const std::string_view begin = trimmed(header);
    if (begin.starts_with('{') || begin.starts_with('[')) {
        return malformed("this is JSON, a model or a report perhaps, and no table");
    }
    if (begin.find('\r') != std::string_view::npos) {
        return malformed("line 1: the lines end in carriage returns alone: end them in line feeds");
    }
    return {};
}

// Files that are no comma-separated UTF-8 have names for their columns that would puzzle more than help.
Status check_encoding(std::string_view header) {
    if (header.starts_with("\xFF\xFE") || header.starts_with("\xFE\xFF")) {
        return malformed("the text is UTF-16: save it as UTF-8 or ASCII");
    }
    if (header.find('\0') != std::string_view::npos) {
        return malformed("line 1 holds zero bytes: not a text file, or UTF-16; save it as UTF-8 or ASCII");
    }
    if (header.find(',') != std::string_view::npos) { return {}; }
    for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
        if (trimmed(header).find(separator) != std::string_view::npos) {
            return malformed(
                fmt::format("line 1: the columns are separated by {}: separate them by commas, with a point "
                            "in the numbers",
                            name));
        }
    }
    return {};
}

}  // namespace

Status CsvTable::feed(std::string_view piece) {
    constexpr std::size_t looked_at_bytes = 4096;
    const std::string_view beginning =
        piece.substr(0, looked_at_bytes - std::min(looked_at_bytes, looked_at_));
    looked_at_ += beginning.size();
    if (std::ranges::any_of(beginning, is_binary)) { return malformed("this is no text, and no capture"); }
    while (!piece.empty()) {
        const std::size_t end = piece.find('\n');
        if (end == std::string_view::npos) {
            rest_.append(piece);
            return check_length(rest_);
        }
        if (rest_.empty()) {
            GYROLOG_CHECK(line(piece.substr(0, end)));
        } else {
            rest_.append(piece.substr(0, end));
            GYROLOG_CHECK(check_length(rest_));
            GYROLOG_CHECK(line(rest_));
            rest_.clear();
        }
        piece.remove_prefix(end + 1);
    }
    return {};
}

Status CsvTable::check_length(std::string_view line) const {
    if (line.size() <= input_limits.line_bytes_most) { return {}; }
    return malformed(fmt::format("line {} is longer than {} bytes: no table of numbers", number_ + 1,
                                 input_limits.line_bytes_most));
}

Status CsvTable::finish() {
    if (!rest_.empty()) { GYROLOG_CHECK(line(rest_)); }
    if (columns_.empty()) { return malformed("empty: line 1 must name the columns, such as " + example_); }
    for (CsvTableColumn& column : columns_) {
        if (column.used) { column.values.resize(column.values.size() - lines_of_row_); }
    }
    lines_of_row_ = 0;
    return {};
}

void CsvTable::end_line() {
    if (lines_per_row_ < 2 || ++lines_of_row_ < lines_per_row_) { return; }
    lines_of_row_ = 0;
    for (CsvTableColumn& column : columns_) {
        if (!column.used) { continue; }
        const std::size_t row = column.values.size() - lines_per_row_;
        double sum = 0.0;
        std::size_t known = 0;
        for (std::size_t i = row; i < column.values.size(); ++i) {
            if (std::isnan(column.values[i])) { continue; }
            sum += column.values[i];
            ++known;
        }
        const std::size_t needed = column.needs_half ? (lines_per_row_ + 1) / 2 : 1;
        column.values[row] = known < needed ? missing : sum / static_cast<double>(known);
        column.values.resize(row + 1);
    }
}

Status CsvTable::line(std::string_view text) {
    ++number_;
    if (!text.empty() && text.back() == '\r') { text.remove_suffix(1); }
    if (number_ == 1) { return header(text); }
    // In a table of one column an empty line is an empty field.
    if (text.empty() && columns_.size() > 1) { return {}; }
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (c > 0) {
            if (at == end) { return wrong_count(text); }
            ++at;  // the comma
        }
        GYROLOG_CHECK(field(columns_[c], at, end));
    }
    if (at != end) { return wrong_count(text); }
    end_line();
    return {};
}

// Reads one field and leaves `at` on the comma after it, or the end of the line.
Status CsvTable::field(CsvTableColumn& column, const char*& at, const char* end) const {
    if (!column.used) {
        at = std::find(at, end, ',');
        return {};
    }
    const char* const begin = at;
    while (at != end && is_blank(*at)) { ++at; }
    double value = missing;
    if (at != end && *at != ',') {
        if (*at == '+' && end - at > 1 && at[1] != '-') { ++at; }
        const auto [stop, problem] = std::from_chars(at, end, value);
        at = stop;
        while (at != end && is_blank(*at)) { ++at; }
        if (problem != std::errc() || (at != end && *at != ',') || std::isinf(value)) {
            return malformed(place(column) + in_quotes({begin, std::find(begin, end, ',')}) +
                             " is no number; leave the field empty where a value is missing");
        }
    }
    if (std::isnan(value)) {
        if (!column.mend_if_empty.empty()) { return malformed(place(column) + column.mend_if_empty); }
    } else if (value < column.lowest || value > column.highest) {
        return malformed(fmt::format("{}{} is not between {:g} and {:g}", place(column), value, column.lowest,
                                     column.highest));
    }
    column.values.push_back(value);
    return {};
}

Status CsvTable::header(std::string_view text) {
    GYROLOG_CHECK(check_encoding(text));
    if (text.starts_with("\xEF\xBB\xBF")) { text.remove_prefix(3); }
    GYROLOG_CHECK(check_kind(text));
    std::set<std::string> names;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string name(trimmed(text.substr(0, comma)));
        if (!names.insert(name).second) {
            return malformed("line 1: column " + in_quotes(name) + " appears twice");
        }
        if (names.size() > input_limits.columns_most) {
            return malformed(fmt::format("line 1 names more than {} columns", input_limits.columns_most));
        }
        CsvTableColumn column;
        column.header = name;
        columns_.push_back(std::move(column));
        if (comma == std::string_view::npos) { break; }
        text.remove_prefix(comma + 1);
    }
    return rule_(columns_);
}

Status CsvTable::wrong_count(std::string_view text) const {
    const auto fields = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
    const std::string place = fields < columns_.size()
                                  ? "; the first without one is column " + in_quotes(columns_[fields].header)
                                  : "; the last of them is column " + in_quotes(columns_.back().header);
    return malformed("line " + std::to_string(number_) + ": " + counted(fields, "field") +
                     " where line 1 names " + counted(columns_.size(), "column") + place);
}

std::string CsvTable::place(const CsvTableColumn& column) const {
    return "line " + std::to_string(number_) + ", column " + in_quotes(column.header) + ": ";
}

Status read_csv_file(CsvTable& table, const std::string& path, std::size_t lines_most) {
    GYROLOG_TRY(TextReader reader, TextReader::open(path));
    while (true) {
        if (table.lines() >= lines_most) {
            table.drop_unfinished_line();
            return table.finish();
        }
        GYROLOG_TRY(const std::string_view piece, reader.read());
        if (piece.empty()) { return table.finish(); }
        GYROLOG_CHECK(table.feed(piece));
    }
}

}  // namespace gyrolog
