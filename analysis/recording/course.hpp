// A column's course in time: means over equal parts of a recording.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Of each of `parts` equal parts of the grid, the mean of the samples in it that are known, in the column's
// unit; NaN where there is none. At least one part.
std::vector<double> course_of(const Recording& recording, const Column& column, std::size_t parts);

}  // namespace gyrolog
