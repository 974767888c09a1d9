// The square of a number, for what is too long to write twice.
#pragma once

namespace gyrolog {

constexpr double square(double value) { return value * value; }

}  // namespace gyrolog
