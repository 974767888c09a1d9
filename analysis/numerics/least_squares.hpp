// The parameters at which a sum of squared residuals is least, by Levenberg's and Marquardt's search as
// MINPACK has it (lmder; J. J. More, Lecture Notes in Mathematics 630 (1978) 105-116).
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

struct LeastSquaresProblem {
    std::size_t residuals = 0;  // at least as many as parameters
    // Writes the residuals at these parameters.
    std::function<void(std::span<const double> at, std::span<double> residuals)> evaluate;
    // Writes their derivatives: row of a residual, column of a parameter. Without it they are forward
    // differences.
    std::function<void(std::span<const double> at, Matrix& derivatives)> differentiate{};
};

struct LeastSquaresLimits {
    // Relative, of the sum of squares and of the parameters.
    double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
    int evaluations_most = 400;
};

// A minimum near `start`, or the best place at which a limit ended the search.
std::vector<double> least_squares(const LeastSquaresProblem& problem, std::span<const double> start,
                                  const LeastSquaresLimits& limits);

// The derivatives at these parameters by central differences over steps of the root of `relative_error`,
// which is that of the residuals.
Matrix central_differences(const LeastSquaresProblem& problem, std::span<const double> at,
                           double relative_error);

}  // namespace gyrolog
