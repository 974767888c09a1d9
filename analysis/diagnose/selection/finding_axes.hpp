// The axes of a finding, some of which may be given to another.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The finding on some of its axes, with what it gains on them. No value where its entries are not of single
// axes.
std::optional<Finding> on_axes(const Finding& finding, const std::vector<std::size_t>& axes);

// The finding on the axes of another one of the same effect as well. No value where they share an axis, or
// where entries are not of single axes.
std::optional<Finding> on_more_axes(Finding finding, const Finding& more);

}  // namespace gyrolog
