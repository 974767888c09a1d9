// What other programs call the columns of a recording, and what that is in the names that csv_column() knows.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gyrolog {

// A name that another program gives, taken apart.
struct DialectName {
    std::string quantity;  // as recording.md begins its names: "t", "gx", "ay", "temp"
    std::string unit;      // as it ends them: "dps", "m_s2", "ns"; empty: the name does not tell
    std::size_t rank = 0;  // of two names for one time, that with the lower one is meant
};

// By the tables of names and of units in the source: case, blanks and underscores do not matter, and the unit
// stands in brackets or at the end. Nothing for a name that is not understood.
std::optional<DialectName> dialect_name(std::string_view header);

// The unit of the quantity that begins with this letter (DialectName), as csv_column() has it, from what
// people write: 'g' and "deg/s" give "dps". Nothing for what is none.
std::optional<std::string> dialect_unit(char quantity, std::string_view written);

}  // namespace gyrolog
