// An Allan plot in characters, for a terminal.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"

namespace gyrolog {

// Three axes over each other on logarithmic scales: x, y and z at the points, dots in between. `columns` by
// `rows` characters at most, the two scales included; no row without a positive deviation, or below 30 by 5.
std::vector<std::string> allan_chart(const std::array<const AllanCurve*, 3>& axes, std::size_t columns,
                                     std::size_t rows);

}  // namespace gyrolog
