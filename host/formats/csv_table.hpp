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
    std::vector<double> values{};  // a row each; NaN for an empty field or "nan"
};

// Takes text in pieces that may end anywhere, and keeps the numbers. After an error it is finished.
// Errors: malformed, naming the line, the column and what to do.
class CsvTable {
public:
    // Sees the columns' names and says which are used and how.
    using HeaderRule = std::function<Status(std::vector<CsvTableColumn>& columns)>;

    // `example`: a header line, for the message about an empty file.
    CsvTable(std::string example, HeaderRule rule) : example_(std::move(example)), rule_(std::move(rule)) {}

    Status feed(std::string_view piece);
    Status finish();

    std::vector<CsvTableColumn>& columns() { return columns_; }
    std::size_t lines() const { return number_; }  // whole ones, the header line included

private:
    Status line(std::string_view text);
    Status header(std::string_view text);
    Status field(CsvTableColumn& column, const char*& at, const char* end) const;
    Status wrong_count(std::string_view text) const;
    std::string place(const CsvTableColumn& column) const;

    std::string example_;
    HeaderRule rule_;
    std::vector<CsvTableColumn> columns_;
    std::string rest_;
    std::size_t number_ = 0;  // of the line
};

// The whole file, compressed or not; no further than it takes to have `lines_most`.
Status read_csv_file(CsvTable& table, const std::string& path,
                     std::size_t lines_most = std::numeric_limits<std::size_t>::max());

}  // namespace gyrolog
