// The Occam factor of a parameter is what its freedom costs in a Bayes factor (D. J. C. MacKay, Bayesian
// interpolation, Neural Computation 4 (1992) 415).
#pragma once

namespace gyrolog {

// The function returns ln(range / (sqrt(2 pi) sd)), in nats: the cost of a parameter that is uniform over
// `range` a priori and normal with `sd` a posteriori, both in the parameter's unit. The cost is at least half
// a nat.
double parameter_cost_nats(double range, double sd);

}  // namespace gyrolog
