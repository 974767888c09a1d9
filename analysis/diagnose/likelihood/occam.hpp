// The Occam factor of a parameter is what its freedom costs in a Bayes factor (D. J. C. MacKay, Bayesian
// interpolation, Neural Computation 4 (1992) 415).
#pragma once

#include <span>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// The function returns ln(range / (sqrt(2 pi) sd)), in nats: the cost of a parameter that is uniform over
// `range` a priori and normal with `sd` a posteriori, both in the parameter's unit. The cost is at least half
// a nat.
double parameter_cost_nats(double range, double sd);

// The same of parameters that are known together, `information` being the inverse of their covariance:
// ln(prod(range) / sqrt((2 pi)^n det(covariance))). The standard deviations of parameters that may give way
// to each other are wider than what is left of their ranges. Every direction in the units of the ranges, the
// eigenvectors of R information R with R the ranges, costs at least half a nat.
double joint_parameter_cost_nats(const Matrix& information, std::span<const double> ranges);

}  // namespace gyrolog
