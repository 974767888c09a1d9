// Linear least squares: of a design with as many independent columns as it has the one solution, of one with
// fewer the smallest (the inverse of Moore and Penrose) or one of them.
#pragma once

#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// The estimators: its product with what was measured is the smallest solution.
Matrix pseudo_inverse(const Matrix& design);

// A solution alone, by QR with pivots.
std::vector<double> solve_least_squares(const Matrix& design, std::span<const double> measured);

}  // namespace gyrolog
