// The grid on which a converter's numbers lie, after they were scaled and printed.
#pragma once

#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Of the step: how far the rounding of printed decimals may put a value from its place on the grid.
inline constexpr double on_grid_tolerance = 0.05;

// The step that all values are whole multiples of apart, to that tolerance. 0: there is none, or there are
// fewer than four different values, or values hardly repeat. NaN is passed over.
double grid_step(std::span<const double> values);

// Of a column's values, in its unit: of counts their scale.
double grid_step(const Column& column);

}  // namespace gyrolog
