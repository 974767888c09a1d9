// The overlapping Allan deviation by the loop that anyone would write first: double precision, theta built
// once, one thread, -Ofast. What benchmarks are held against.
#pragma once

#include <vector>

namespace gyrolog {

// By averaging factor, those of averaging_factors().
std::vector<double> obvious_curve(const std::vector<double>& rate, double rate_hz);

}  // namespace gyrolog
