// The covariance at which a Kalman filter with constant matrices settles.
//
//   P = F P F' - F P H' (H P H' + R)^-1 H P F' + Q
//
// by the structure-preserving doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang,
// "Structure-preserving algorithms for periodic discrete-time algebraic Riccati equations", Int. J. Control
// 77 (2004) 767-788), on the filter's dual form with G = H' R^-1 H: k doublings are 2^k steps of the filter.
#pragma once

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

struct SteadyCovariance {
    Matrix covariance;  // before the measurement
    int doublings = 0;
    bool settled = false;  // false: no steady state, or none within 2^60 steps
};

// R is positive definite, Q positive semidefinite, and what H does not show must not wander.
SteadyCovariance steady_covariance(const Matrix& F, const Matrix& H, const Matrix& Q, const Matrix& R);

}  // namespace gyrolog
