// The curvature of a log-likelihood about its maximum is the information about its parameters: the inverse of
// their covariance, all together (observed Fisher information).
#pragma once

#include <functional>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

struct PeakCurvature {
    Matrix information;      // positive definite
    std::vector<double> sd;  // by parameter, the others free; at most `sd_most`
};

// `at`: the maximum, of `value`. Central differences over steps that begin with `step_least` and double until
// the function falls by a quarter of a unit on each side, so that neither rounding nor a flat top misleads.
// The function may be -infinity where it is not defined; at such an end one side tells. A direction that is
// known worse than `sd_most` is known as well as that.
PeakCurvature peak_curvature(const std::function<double(const std::vector<double>&)>& log_likelihood,
                             const std::vector<double>& at, double value, double step_least, double sd_most);

}  // namespace gyrolog
