#include "analysis/numerics/least_squares.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// H. H. Rosenbrock's valley (Computer J. 3 (1960) 175): least, and 0, at (1, 1).
LeastSquaresProblem rosenbrock() {
    LeastSquaresProblem problem;
    problem.residuals = 2;
    problem.evaluate = [](std::span<const double> x, std::span<double> residuals) {
        residuals[0] = 10.0 * (x[1] - x[0] * x[0]);
        residuals[1] = 1.0 - x[0];
    };
    return problem;
}

TEST(LeastSquares, FindsTheEndOfTheValleyByDifferences) {
    const std::vector<double> x = least_squares(rosenbrock(), std::vector{-1.2, 1.0}, {});
    EXPECT_NEAR(x[0], 1.0, 1e-7);
    EXPECT_NEAR(x[1], 1.0, 1e-7);
}

TEST(LeastSquares, FindsTheEndOfTheValleyByDerivatives) {
    LeastSquaresProblem problem = rosenbrock();
    int calls = 0;
    problem.differentiate = [&](std::span<const double> x, Matrix& derivatives) {
        ++calls;
        derivatives(0, 0) = -20.0 * x[0];
        derivatives(0, 1) = 10.0;
        derivatives(1, 0) = -1.0;
        derivatives(1, 1) = 0.0;
    };
    const std::vector<double> x = least_squares(problem, std::vector{-1.2, 1.0}, {});
    EXPECT_NEAR(x[0], 1.0, 1e-9);
    EXPECT_NEAR(x[1], 1.0, 1e-9);
    EXPECT_GT(calls, 3);
}

TEST(LeastSquares, EndsAtItsLimit) {
    LeastSquaresProblem problem = rosenbrock();
    int evaluations = 0;
    problem.evaluate = [&, inner = problem.evaluate](std::span<const double> x, std::span<double> residuals) {
        ++evaluations;
        inner(x, residuals);
    };
    LeastSquaresLimits limits;
    limits.evaluations_most = 6;
    const std::vector<double> x = least_squares(problem, std::vector{-1.2, 1.0}, limits);
    EXPECT_LT(evaluations, 12);
    EXPECT_GT(std::abs(x[0] - 1.0), 1e-3);
}

TEST(CentralDifferences, AreTheDerivatives) {
    const Matrix derivatives = central_differences(rosenbrock(), std::vector{0.5, 2.0}, 1e-10);
    EXPECT_NEAR(derivatives(0, 0), -10.0, 1e-6);
    EXPECT_NEAR(derivatives(0, 1), 10.0, 1e-6);
    EXPECT_NEAR(derivatives(1, 0), -1.0, 1e-6);
    EXPECT_NEAR(derivatives(1, 1), 0.0, 1e-6);
}

}  // namespace
}  // namespace gyrolog
