#pragma once

namespace gyrolog {

constexpr double square(double value) { return value * value; }

}  // namespace gyrolog
