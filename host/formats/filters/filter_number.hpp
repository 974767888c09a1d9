// What filters take in the place of a density: the `of` of FilterNumber.
#pragma once

#include <cmath>

namespace gyrolog {

constexpr double continuous(double density, double /*rate_hz*/) { return density; }
constexpr double squared(double density, double /*rate_hz*/) { return density * density; }

// Of a filter whose variance grows by (number * dt)^2 a step: density / sqrt(dt), for N as for K.
inline double once_a_sample(double density, double rate_hz) { return density * std::sqrt(rate_hz); }

// The same of a filter that steps by itself, Hz.
template <int step_rate_hz>
double once_a_step(double density, double /*rate_hz*/) {
    return density * std::sqrt(static_cast<double>(step_rate_hz));
}

}  // namespace gyrolog
