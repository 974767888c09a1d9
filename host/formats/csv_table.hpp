// Comma-separated numbers below one header line: what a recording and a curve in text have in common.
#pragma once

#include <functional>
#include <limits>
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
    double lowest = -std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::max();
    bool needs_half = false;       // of the lines of a row, for their mean not to be NaN; else one is enough
    std::vector<double> values{};  // a row each; NaN for an empty field or "nan"
};

// Takes text in pieces that may end anywhere, and keeps the numbers. After an error it is finished.
// Errors: malformed, naming the line, the column and what to do.
class CsvTable {
public:
    // Sees the columns' names and says which are used and how.
    using HeaderRule = std::function<Status(std::vector<CsvTableColumn>& columns)>;

    // `example`: a header line, for the message about an empty file. With more than one line a row, a row
    // holds the means of so many lines, and what is left at the end is none; only rows take memory.
    CsvTable(std::string example, HeaderRule rule, std::size_t lines_per_row = 1)
        : example_(std::move(example)), rule_(std::move(rule)), lines_per_row_(lines_per_row) {}

    Status feed(std::string_view piece);
    void drop_unfinished_line() { rest_.clear(); }
    Status finish();

    std::vector<CsvTableColumn>& columns() { return columns_; }
    std::size_t lines() const { return number_; }  // whole ones, the header line included

private:
    Status line(std::string_view text);
    Status header(std::string_view text);
    Status field(CsvTableColumn& column, const char*& at, const char* end) const;
    void end_line();
    Status wrong_count(std::string_view text) const;
    Status check_length(std::string_view line) const;
    std::string place(const CsvTableColumn& column) const;

    std::string example_;
    HeaderRule rule_;
    std::size_t lines_per_row_;
    std::size_t lines_of_row_ = 0;  // of the last row, while it is not whole: each has its values yet
    std::vector<CsvTableColumn> columns_;
    std::string rest_;
    std::size_t number_ = 0;     // of the line
    std::size_t looked_at_ = 0;  // bytes, for what no text holds
};

// The whole file, compressed or not; no further than it takes to have `lines_most`.
Status read_csv_file(CsvTable& table, const std::string& path,
                     std::size_t lines_most = std::numeric_limits<std::size_t>::max());

}  // namespace gyrolog
