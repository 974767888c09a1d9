// Two halves of a recording have nothing in common, so that what is fitted to one can be judged by the other.
// What is read from frequencies takes every other pair of cosine coefficients; what is read from single
// samples takes every other one of as many equal parts of the time. Both sorts are independent where the
// model of the noise is right.
#pragma once

#include <cstddef>

namespace gyrolog {

namespace resolution {

inline constexpr std::size_t half_parts = 64;  // of the time, in turns

}  // namespace resolution

enum class Half { both, first, second };

// Coefficients go in pairs: of a ramp, and of whatever else is odd about the middle, only odd coefficients
// are not zero.
constexpr bool has_coefficient(Half half, std::size_t k) {
    return half == Half::both || ((k / 2) % 2 == 0) == (half == Half::first);
}

constexpr bool has_slot(Half half, std::size_t slot, std::size_t length) {
    return half == Half::both || ((slot * resolution::half_parts / length) % 2 == 0) == (half == Half::first);
}

}  // namespace gyrolog
