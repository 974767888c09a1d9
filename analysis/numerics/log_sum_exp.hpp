// The sum of numbers that are known by their logarithms.
#pragma once

#include <limits>
#include <span>

namespace gyrolog {

// The logarithm of nothing.
inline constexpr double minus_infinity = -std::numeric_limits<double>::infinity();

// The function returns ln sum_i exp(terms_i) of at least one term. The largest term is taken out of the sum,
// so that nothing overflows.
double log_sum_exp(std::span<const double> terms);

}  // namespace gyrolog
