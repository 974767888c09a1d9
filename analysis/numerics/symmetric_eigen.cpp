#include "analysis/numerics/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

SymmetricEigen symmetric_eigen(const Matrix& symmetric) {
    const Solver solver(view_of(symmetric));
    SymmetricEigen eigen;
    eigen.values.assign(solver.eigenvalues().begin(), solver.eigenvalues().end());
    eigen.vectors = Matrix(symmetric.rows(), symmetric.columns());
    view_of(eigen.vectors) = solver.eigenvectors();
    return eigen;
}

std::vector<double> symmetric_eigenvalues(const Matrix& symmetric) {
    const Solver solver(view_of(symmetric), Eigen::EigenvaluesOnly);
    return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

}  // namespace gyrolog
