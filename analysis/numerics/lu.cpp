#include "analysis/numerics/lu.hpp"

#include <Eigen/LU>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

struct LuFactors::Factors {
    Eigen::PartialPivLU<Eigen::MatrixXd> of;
};

LuFactors::LuFactors(const Matrix& square)
    : factors_(std::make_unique<Factors>(Factors{Eigen::PartialPivLU<Eigen::MatrixXd>(view_of(square))})) {}

LuFactors::~LuFactors() = default;

Matrix LuFactors::solve(const Matrix& right) const {
    Matrix solved(right.rows(), right.columns());
    view_of(solved) = factors_->of.solve(view_of(right));
    return solved;
}

}  // namespace gyrolog
