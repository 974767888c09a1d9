// The simplex method finds the maximum of a function of a few variables without derivatives (J. A. Nelder, R.
// Mead, Computer Journal 7 (1965) 308-313).
#pragma once

#include <functional>
#include <vector>

namespace gyrolog {

struct SimplexMaximum {
    std::vector<double> at;
    double value = 0.0;
};

// `step` is the first size of the simplex in each variable. The search ends when the values at the corners
// differ by less than `tolerance`, or after `most` evaluations. The function may return -infinity where it is
// not defined, but not at `start`.
SimplexMaximum simplex_maximum(const std::function<double(const std::vector<double>&)>& function,
                               const std::vector<double>& start, double step, double tolerance,
                               int most = 400);

}  // namespace gyrolog
