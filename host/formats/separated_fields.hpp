// One line of a table, cut into fields.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace gyrolog {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// Without the blanks around it.
std::string_view trimmed(std::string_view text);

// The same without the quotation marks around it; what is in them keeps its own blanks.
std::string_view unquoted(std::string_view text);

// Where the field that begins at `begin` ends: at the separator behind it, or the end of the line. A
// separator within quotation marks that are closed right before the next one is part of the field.
std::size_t end_of_field(std::string_view line, std::size_t begin, char separator);

// `separator` is ' ' for runs of blanks: then brackets hold their blanks together, as in "timestamp [ns]",
// and belong to the name before them.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

// Of commas, semicolons and tabs that which a line of names shows most; the former of two. Without any ' '
// where there are blanks between words, else ','.
char separator_of_names(std::string_view line);

// The one by which a line falls into numbers alone: a semicolon or a tab before a comma, which may be the
// decimal mark. 0: none does.
char separator_of_numbers(std::string_view line);

// A number, empty or "nan", quoted or not, with a decimal comma where the separator is another one.
bool is_number_field(std::string_view field, char separator);

}  // namespace gyrolog
