// Which axes an effect may act on.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

// Every choice of one or more of them, single axes first.
std::vector<std::vector<std::size_t>> axis_subsets(std::span<const std::size_t> axes);

}  // namespace gyrolog
