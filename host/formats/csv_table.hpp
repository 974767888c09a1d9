// Numbers in columns below a line that names them: what a recording and a curve in text have in common.
//
// Columns are separated by commas, semicolons, tabs or runs of blanks, whichever the line of names shows
// most; where it is not the comma, numbers may have decimal commas instead of points, one of them in the
// whole file. Names and numbers may stand in quotation marks. Comments, lines that begin with # or %, and
// empty lines may come before the names; the last comment is the line of names itself where numbers follow it
// and it has as many fields.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

struct CsvTableColumn {
    std::string header;
    bool used = false;  // else its fields are skipped, whatever they are
    // What to do about an empty field, as the end of an error message; empty: such a field is NaN.
    std::string mend_if_empty{};
    // The same about a field that is no number.
    std::string mend_if_word = "leave the field empty where a value is missing";
    double lowest = -std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::max();
    bool needs_half = false;       // of the lines of a row, for their mean not to be NaN; else one is enough
    std::vector<double> values{};  // a row each; NaN for an empty field or "nan"
};

struct CsvTableForm {
    std::string example;             // a line of names, for messages
    std::string mend_if_headless{};  // what else than such a line helps, as the end of an error message
    // Of the columns by position, in place of a line of names, which there may be or not; those beyond have
    // their own names or none.
    std::vector<std::string> names{};
    // More: a row holds the means of so many, and what is left at the end is none; only rows take memory.
    std::size_t lines_per_row = 1;
};

// Takes text in pieces that may end anywhere, and keeps the numbers. After an error it is finished.
// Errors: malformed, naming the line, the column and what to do.
class CsvTable {
public:
    // Sees the columns' names and says which are used and how. Its error need not name the line.
    using HeaderRule = std::function<Status(std::vector<CsvTableColumn>& columns)>;

    CsvTable(CsvTableForm form, HeaderRule rule) : form_(std::move(form)), rule_(std::move(rule)) {}

    Status feed(std::string_view piece);
    void drop_unfinished_line() { rest_.clear(); }
    Status finish();

    std::vector<CsvTableColumn>& columns() { return columns_; }
    // Those of the file's own that the form's names stand for.
    const std::vector<std::string>& replaced_names() const { return replaced_names_; }
    // Whole ones from that of the names on.
    std::size_t lines() const { return columns_.empty() ? 0 : number_ - header_number_ + 1; }

private:
    enum class DecimalMark { any, point, comma };

    Status line(std::string_view text);
    Status comma_row(std::string_view text);
    Status other_row(std::string_view text);
    Status beginning(std::string_view text);
    Status first_row(std::string_view text);
    Status header(std::string_view text, std::size_t number);
    Status name_columns(std::vector<std::string> names, bool names_are_own);
    Status field(CsvTableColumn& column, const char*& at, const char* end) const;
    Status quoted_field(CsvTableColumn& column, const char* begin, const char*& at, const char* end) const;
    Status unfit(const CsvTableColumn& column, double value) const;
    Status other_number(const CsvTableColumn& column, std::string_view text, double& value);
    Status no_number(const CsvTableColumn& column, std::string_view text) const;
    void end_line();
    Status wrong_count(std::size_t fields) const;
    Status check_length(std::string_view line) const;
    std::string place(const CsvTableColumn& column) const;

    CsvTableForm form_;
    HeaderRule rule_;
    std::size_t lines_of_row_ = 0;  // of the last row, while it is not whole: each has its values yet
    std::vector<CsvTableColumn> columns_;
    std::vector<std::string> replaced_names_;
    char separator_ = ',';  // ' ': runs of blanks
    DecimalMark decimal_mark_ = DecimalMark::any;
    std::size_t decimal_mark_number_ = 0;   // of the line that showed it
    std::vector<std::string_view> fields_;  // of one line
    std::string comment_;                   // the last one, without its mark
    std::size_t comment_number_ = 0;        // of its line; 0: none
    std::size_t header_number_ = 0;
    std::string rest_;
    std::size_t number_ = 0;     // of the line
    std::size_t looked_at_ = 0;  // bytes, for what no text holds
};

// Of one column in the lines of a row: of those that are known, NaN where there are too few.
double mean_of_lines(std::span<const double> lines, bool needs_half);

// The whole file, compressed or not; no further than it takes to have `lines_most`.
Status read_csv_file(CsvTable& table, const std::string& path,
                     std::size_t lines_most = std::numeric_limits<std::size_t>::max());

}  // namespace gyrolog
