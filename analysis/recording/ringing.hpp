// What rings out after a blow: a damped oscillation.
#pragma once

#include <span>
#include <vector>

namespace gyrolog {

// What is left of the values about a level m and the damped oscillation that explains most of them,
//   m + exp(-t / tau) (a cos(2 pi f t) + b sin(2 pi f t))   from t = 0 on, m before it,
// by least squares in m, a and b at each point of a grid of onsets, frequencies and decays: with the three of
// the grid six parameters. The frequency has 1 to 8 half periods in all values. Wants eight values or more;
// fewer come back about their mean.
std::vector<double> without_ringing(std::span<const double> values);

}  // namespace gyrolog
