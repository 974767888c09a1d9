#include "analysis/numerics/least_squares.hpp"

#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// What Eigen's functions ask for.
struct Residuals {
    using Scalar = double;
    using InputType = VectorXd;
    using ValueType = VectorXd;
    using JacobianType = MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

    const LeastSquaresProblem* problem;

    int values() const { return static_cast<int>(problem->residuals); }
    int operator()(const VectorXd& at, VectorXd& residuals) const {
        problem->evaluate(values_of(at), {residuals.data(), static_cast<std::size_t>(residuals.size())});
        return 0;
    }
};

struct DifferentiatedResiduals : Residuals {
    // The number of evaluations that it took.
    int df(const VectorXd& at, MatrixXd& derivatives) const {
        if (!problem->differentiate) { return Eigen::NumericalDiff<Residuals>(*this).df(at, derivatives); }
        Matrix written(problem->residuals, static_cast<std::size_t>(at.size()));
        problem->differentiate(values_of(at), written);
        derivatives = view_of(written);
        return 0;
    }
};

}  // namespace

std::vector<double> least_squares(const LeastSquaresProblem& problem, std::span<const double> start,
                                  const LeastSquaresLimits& limits) {
    DifferentiatedResiduals residuals{{&problem}};
    VectorXd at = view_of(start);
    Eigen::LevenbergMarquardt<DifferentiatedResiduals> search(residuals);
    search.parameters.ftol = limits.tolerance;
    search.parameters.xtol = limits.tolerance;
    search.parameters.maxfev = limits.evaluations_most;
    search.minimize(at);
    return {at.begin(), at.end()};
}

Matrix central_differences(const LeastSquaresProblem& problem, std::span<const double> at,
                           double relative_error) {
    const Eigen::NumericalDiff<Residuals, Eigen::Central> differentiated(Residuals{&problem}, relative_error);
    MatrixXd derivatives(static_cast<Eigen::Index>(problem.residuals), static_cast<Eigen::Index>(at.size()));
    differentiated.df(view_of(at), derivatives);
    return matrix_of(derivatives);
}

}  // namespace gyrolog
