// How many simulations a diagnosis may be asked for.
#pragma once

#include <cstddef>

namespace gyrolog {

inline constexpr std::size_t simulations_least = 20;
inline constexpr std::size_t simulations_most = 10'000;

}  // namespace gyrolog
