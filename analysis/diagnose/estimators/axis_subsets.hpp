// Axis subsets are the choices of axes that an effect may act on.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gyrolog {

// The function returns every choice of one or more of the axes, single axes first.
std::vector<std::vector<std::size_t>> axis_subsets(std::span<const std::size_t> axes);

// The functions return what the freedom of the choice costs: the logarithm of the number of choices, all of
// them alike beforehand; or, where each axis has the effect or has it not, that of one axis. Of one axis
// there is nothing to choose.
double axis_choice_nats(std::size_t axes);
double axis_membership_nats(std::size_t axes);

}  // namespace gyrolog
