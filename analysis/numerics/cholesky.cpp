#include "analysis/numerics/cholesky.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

struct CholeskyFactor::Factor {
    Eigen::LLT<Eigen::MatrixXd> of;
};

CholeskyFactor::CholeskyFactor(const Matrix& symmetric)
    : factor_(std::make_unique<Factor>(Factor{Eigen::LLT<Eigen::MatrixXd>(view_of(symmetric))})) {}

CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;

bool CholeskyFactor::is_positive_definite() const { return factor_->of.info() == Eigen::Success; }

std::vector<double> CholeskyFactor::solve(std::span<const double> right) const {
    std::vector<double> solved(right.begin(), right.end());
    auto view = view_of(std::span<double>(solved));
    factor_->of.solveInPlace(view);
    return solved;
}

Matrix CholeskyFactor::solve(Matrix right) const {
    auto view = view_of(right);
    factor_->of.solveInPlace(view);
    return right;
}

std::vector<double> CholeskyFactor::solve_transposed(std::span<const double> right) const {
    std::vector<double> solved(right.begin(), right.end());
    auto view = view_of(std::span<double>(solved));
    factor_->of.matrixU().solveInPlace(view);
    return solved;
}

Matrix CholeskyFactor::inverse() const {
    return solve(Matrix::identity(static_cast<std::size_t>(factor_->of.rows())));
}

double CholeskyFactor::log_determinant() const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < factor_->of.rows(); ++i) {
        sum += 2.0 * std::log(factor_->of.matrixLLT()(i, i));
    }
    return sum;
}

std::vector<double> solve_symmetric(const Matrix& symmetric, std::span<const double> right) {
    std::vector<double> solved(right.size());
    view_of(std::span<double>(solved)) =
        Eigen::LDLT<Eigen::MatrixXd>(view_of(symmetric)).solve(view_of(right));
    return solved;
}

Matrix solve_symmetric(const Matrix& symmetric, const Matrix& right) {
    Matrix solved(right.rows(), right.columns());
    view_of(solved) = Eigen::LDLT<Eigen::MatrixXd>(view_of(symmetric)).solve(view_of(right));
    return solved;
}

}  // namespace gyrolog
