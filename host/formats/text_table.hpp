// Tables for a terminal: a label, its unit, and a cell for each column.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace gyrolog {

struct TextRow {
    std::string label;
    std::string unit;
    std::vector<std::string> cells;
};

// Rows of as many cells as there are heads. Columns that do not fit into `width_max` characters go into
// further tables below.
std::string text_table(std::span<const std::string> heads, std::span<const TextRow> rows,
                       std::size_t width_max = 80);

}  // namespace gyrolog
