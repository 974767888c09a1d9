#include "analysis/numerics/pseudo_inverse.hpp"

#include <Eigen/QR>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

Matrix pseudo_inverse(const Matrix& design) {
    Matrix inverse(design.columns(), design.rows());
    view_of(inverse) =
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(view_of(design)).pseudoInverse();
    return inverse;
}

std::vector<double> solve_least_squares(const Matrix& design, std::span<const double> measured) {
    const Eigen::VectorXd solution =
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(view_of(design)).solve(view_of(measured));
    return {solution.begin(), solution.end()};
}

}  // namespace gyrolog
