// The uniform distribution.
#pragma once

namespace gyrolog {

// Of what is anywhere within `width`, as the error of rounding to steps of that width.
constexpr double variance_of_uniform(double width) { return width * width / 12.0; }

}  // namespace gyrolog
