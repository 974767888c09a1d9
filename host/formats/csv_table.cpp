#include "host/formats/csv_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <span>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/separated_fields.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

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

// Text in other encodings has names for its columns that would puzzle more than help.
Status check_encoding(std::string_view header) {
    if (header.starts_with("\xFF\xFE") || header.starts_with("\xFE\xFF")) {
        return malformed("the text is UTF-16: save it as UTF-8 or ASCII");
    }
    if (header.find('\0') != std::string_view::npos) {
        return malformed("line 1 holds zero bytes: not a text file, or UTF-16; save it as UTF-8 or ASCII");
    }
    return {};
}

bool fits(const CsvTableColumn& column, double value) {
    if (std::isnan(value)) { return column.mend_if_empty.empty(); }
    return value >= column.lowest && value <= column.highest;
}

}  // namespace

double mean_of_lines(std::span<const double> lines, bool needs_half) {
    double sum = 0.0;
    std::size_t known = 0;
    for (const double value : lines) {
        if (std::isnan(value)) { continue; }
        sum += value;
        ++known;
    }
    const std::size_t needed = needs_half ? (lines.size() + 1) / 2 : 1;
    return known < needed ? missing : sum / static_cast<double>(known);
}

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
    if (columns_.empty() && comment_number_ > 0) { GYROLOG_CHECK(header(comment_, comment_number_)); }
    if (columns_.empty()) {
        return malformed("empty: line 1 must name the columns, such as " + form_.example);
    }
    for (CsvTableColumn& column : columns_) {
        if (column.used) { column.values.resize(column.values.size() - lines_of_row_); }
    }
    lines_of_row_ = 0;
    return {};
}

void CsvTable::end_line() {
    if (++lines_of_row_ < form_.lines_per_row) { return; }
    lines_of_row_ = 0;
    const std::size_t lines = form_.lines_per_row;
    for (CsvTableColumn& column : columns_) {
        if (!column.used) { continue; }
        const std::size_t row = column.values.size() - lines;
        column.values[row] = mean_of_lines(std::span(column.values).subspan(row), column.needs_half);
        column.values.resize(row + 1);
    }
}

Status CsvTable::line(std::string_view text) {
    ++number_;
    if (!text.empty() && text.back() == '\r') { text.remove_suffix(1); }
    if (columns_.empty()) { return beginning(text); }
    return separator_ == ',' ? comma_row(text) : other_row(text);
}

// The way that gigabytes go.
Status CsvTable::comma_row(std::string_view text) {
    // In a table of one column an empty line is an empty field.
    if (text.empty() && columns_.size() > 1) { return {}; }
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (c > 0) {
            if (at == end) { return wrong_count(c); }
            ++at;  // the comma
        }
        GYROLOG_CHECK(field(columns_[c], at, end));
    }
    if (at != end) {
        split_fields(text, separator_, fields_);
        return wrong_count(fields_.size());
    }
    if (form_.lines_per_row > 1) { end_line(); }
    return {};
}

// Reads one field and leaves `at` on the comma after it, or the end of the line.
Status CsvTable::field(CsvTableColumn& column, const char*& at, const char* end) const {
    const char* const begin = at;
    if (!column.used) {
        at = std::find(at, end, ',');
        const bool may_be_quoted = at != end && (*begin == '"' || is_blank(*begin));
        if (may_be_quoted) { at = begin + end_of_field({begin, end}, 0, ','); }
        return {};
    }
    while (at != end && is_blank(*at)) { ++at; }
    double value = missing;
    if (at != end && *at != ',') {
        if (*at == '+' && end - at > 1 && at[1] != '-') { ++at; }
        const auto [stop, problem] = std::from_chars(at, end, value);
        at = stop;
        while (at != end && is_blank(*at)) { ++at; }
        if (problem != std::errc() || (at != end && *at != ',') || std::isinf(value)) {
            return quoted_field(column, begin, at, end);
        }
    }
    if (!fits(column, value)) { return unfit(column, value); }
    column.values.push_back(value);
    return {};
}

// What is no number as it stands.
Status CsvTable::quoted_field(CsvTableColumn& column, const char* begin, const char*& at,
                              const char* end) const {
    const std::string_view text(begin, end_of_field({begin, end}, 0, ','));
    const std::string_view inside = trimmed(unquoted(text));
    if (inside.size() == trimmed(text).size() || inside.find_first_of("\",") != std::string_view::npos) {
        return no_number(column, text);
    }
    at = inside.data();
    GYROLOG_CHECK(field(column, at, inside.data() + inside.size()));
    at = begin + text.size();
    return {};
}

Status CsvTable::unfit(const CsvTableColumn& column, double value) const {
    if (std::isnan(value)) { return malformed(place(column) + column.mend_if_empty); }
    return malformed(fmt::format("{}{} is not between {:g} and {:g}", place(column), value, column.lowest,
                                 column.highest));
}

Status CsvTable::no_number(const CsvTableColumn& column, std::string_view text) const {
    return malformed(place(column) + in_quotes(text) + " is no number; " + column.mend_if_word);
}

Status CsvTable::other_row(std::string_view text) {
    if (text.empty() && columns_.size() > 1) { return {}; }
    if (separator_ == ' ' && trimmed(text).empty()) { return {}; }
    split_fields(text, separator_, fields_);
    if (fields_.size() != columns_.size()) { return wrong_count(fields_.size()); }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (!columns_[c].used) { continue; }
        double value = missing;
        GYROLOG_CHECK(other_number(columns_[c], fields_[c], value));
        if (!fits(columns_[c], value)) { return unfit(columns_[c], value); }
        columns_[c].values.push_back(value);
    }
    if (form_.lines_per_row > 1) { end_line(); }
    return {};
}

// Points and commas in one file are thousands of one and decimals of the other, and nobody knows which.
Status CsvTable::other_number(const CsvTableColumn& column, std::string_view text, double& value) {
    std::string_view digits = trimmed(unquoted(text));
    if (digits.empty()) { return {}; }
    std::array<char, 64> with_point{};
    const std::size_t mark = digits.find_first_of(".,");
    if (mark != std::string_view::npos) {
        const DecimalMark found = digits[mark] == ',' ? DecimalMark::comma : DecimalMark::point;
        if (decimal_mark_ == DecimalMark::any) {
            decimal_mark_ = found;
            decimal_mark_number_ = number_;
        }
        if (found != decimal_mark_) {
            const bool comma = found == DecimalMark::comma;
            return malformed(fmt::format("{}{} has a decimal {} where line {} has a {}", place(column),
                                         in_quotes(digits), comma ? "comma" : "point", decimal_mark_number_,
                                         comma ? "point" : "comma"));
        }
        if (found == DecimalMark::comma && digits.size() <= with_point.size()) {
            std::ranges::copy(digits, with_point.begin());
            with_point[mark] = '.';
            digits = {with_point.data(), digits.size()};
        }
    }
    if (digits.front() == '+' && digits.size() > 1 && digits[1] != '-') { digits.remove_prefix(1); }
    const char* const end = digits.data() + digits.size();
    const auto [stop, problem] = std::from_chars(digits.data(), end, value);
    if (problem != std::errc() || stop != end || std::isinf(value)) { return no_number(column, text); }
    return {};
}

Status CsvTable::beginning(std::string_view text) {
    if (number_ == 1) {
        GYROLOG_CHECK(check_encoding(text));
        if (text.starts_with("\xEF\xBB\xBF")) { text.remove_prefix(3); }
        GYROLOG_CHECK(check_kind(text));
    }
    std::string_view content = trimmed(text);
    if (content.empty()) { return {}; }
    if (content.front() == '#' || content.front() == '%') {
        while (!content.empty() && (content.front() == '#' || content.front() == '%')) {
            content.remove_prefix(1);
        }
        comment_ = trimmed(content);
        comment_number_ = number_;
        return {};
    }
    if (separator_of_numbers(text) != 0) { return first_row(text); }
    // A row whose unused columns hold words.
    if (comment_number_ > 0) {
        const char separator = separator_of_names(comment_);
        split_fields(text, separator, fields_);
        const std::size_t fields = fields_.size();
        const bool any_number = std::ranges::any_of(fields_, [&](std::string_view field) {
            return !unquoted(field).empty() && is_number_field(field, separator);
        });
        split_fields(comment_, separator, fields_);
        if (any_number && fields_.size() == fields) { return first_row(text); }
    }
    return header(text, number_);
}

// Numbers, before any line has named their columns: the last comment did, or the user does.
Status CsvTable::first_row(std::string_view text) {
    const char of_numbers = separator_of_numbers(text);
    separator_ = of_numbers != 0 ? of_numbers : separator_of_names(comment_);
    split_fields(text, separator_, fields_);
    const std::size_t fields = fields_.size();
    std::vector<std::string> names;
    for (const char separator : {separator_, separator_of_names(comment_)}) {
        split_fields(comment_, separator, fields_);
        if (comment_number_ > 0 && fields_.size() == fields) {
            names.assign(fields_.size(), {});
            std::ranges::transform(fields_, names.begin(), unquoted);
            break;
        }
    }
    const bool names_are_own = !names.empty();
    header_number_ = names_are_own ? comment_number_ : number_ - 1;
    if (!names_are_own) {
        if (form_.names.empty()) {
            return malformed(
                fmt::format("line {} holds numbers, and no line before it names the columns: put {} before "
                            "it{}",
                            number_, form_.example, form_.mend_if_headless));
        }
        for (std::size_t c = 0; c < fields; ++c) { names.push_back(fmt::format("column {}", c + 1)); }
    }
    GYROLOG_CHECK(name_columns(std::move(names), names_are_own));
    return separator_ == ',' ? comma_row(text) : other_row(text);
}

Status CsvTable::header(std::string_view text, std::size_t number) {
    header_number_ = number;
    separator_ = separator_of_names(text);
    split_fields(text, separator_, fields_);
    std::vector<std::string> names(fields_.size());
    std::ranges::transform(fields_, names.begin(), unquoted);
    return name_columns(std::move(names), true);
}

Status CsvTable::name_columns(std::vector<std::string> names, bool names_are_own) {
    if (names.size() < form_.names.size()) {
        return malformed(fmt::format("line {} has {}, and --columns names {}", number_,
                                     counted(names.size(), "column"), form_.names.size()));
    }
    const std::string line = fmt::format("line {}", std::max<std::size_t>(header_number_, 1));
    if (names.size() > input_limits.columns_most) {
        return malformed(fmt::format("{} names more than {} columns", line, input_limits.columns_most));
    }
    for (std::size_t c = 0; c < form_.names.size(); ++c) {
        if (names_are_own) { replaced_names_.push_back(std::move(names[c])); }
        names[c] = form_.names[c];
    }
    // Those beyond the form's names are not looked at.
    const std::size_t looked_at = form_.names.empty() ? names.size() : form_.names.size();
    std::set<std::string_view> seen;
    for (const std::string& name : std::span(names).first(looked_at)) {
        const bool may_repeat = name.empty() || name == "_" || name == "-";
        if (!may_repeat && !seen.insert(name).second) {
            return malformed(line + ": column " + in_quotes(name) + " appears twice");
        }
    }
    columns_.reserve(names.size());
    for (std::string& name : names) {
        CsvTableColumn column;
        column.header = std::move(name);
        columns_.push_back(std::move(column));
    }
    Status judged = rule_(columns_);
    return judged.ok() ? judged : in_context(line, std::move(judged).error());
}

Status CsvTable::wrong_count(std::size_t fields) const {
    const std::string place = fields < columns_.size()
                                  ? "; the first without one is column " + in_quotes(columns_[fields].header)
                                  : "; the last of them is column " + in_quotes(columns_.back().header);
    return malformed("line " + std::to_string(number_) + ": " + counted(fields, "field") + " where line " +
                     std::to_string(std::max<std::size_t>(header_number_, 1)) + " names " +
                     counted(columns_.size(), "column") + place);
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
