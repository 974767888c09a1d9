// Axis subsets are the choices of axes that an effect may act on.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

// The function returns every choice of one or more of the axes, single axes first.
std::vector<std::vector<std::size_t>> axis_subsets(std::span<const std::size_t> axes);

}  // namespace gyrolog
