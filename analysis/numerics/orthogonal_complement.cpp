#include "analysis/numerics/orthogonal_complement.hpp"

#include <Eigen/Core>
#include <Eigen/Householder>

#include "analysis/numerics/eigen_view.hpp"

namespace gyrolog {

OrthogonalComplement::OrthogonalComplement(std::span<const double> direction)
    : essential_(direction.size() - 1) {
    auto essential = view_of(std::span<double>(essential_));
    double length = 0.0;
    view_of(direction).makeHouseholder(essential, factor_, length);
}

// As a matrix of one column: the products are then those of matrices.
std::vector<double> OrthogonalComplement::of(std::span<const double> vector) const {
    Eigen::MatrixXd x = view_of(vector);
    double workspace = 0.0;
    x.applyHouseholderOnTheLeft(view_of(std::span<const double>(essential_)), factor_, &workspace);
    return {x.data() + 1, x.data() + x.size()};
}

Matrix OrthogonalComplement::of_covariance(const Matrix& covariance) const {
    const std::size_t size = covariance.rows();
    Eigen::MatrixXd x = view_of(covariance);
    std::vector<double> workspace(size);
    const auto essential = view_of(std::span<const double>(essential_));
    x.applyHouseholderOnTheLeft(essential, factor_, workspace.data());
    x.applyHouseholderOnTheRight(essential, factor_, workspace.data());
    Matrix complement(size - 1, size - 1);
    view_of(complement) = x.bottomRightCorner(x.rows() - 1, x.cols() - 1);
    return complement;
}

Matrix OrthogonalComplement::basis() const {
    const auto size = static_cast<Eigen::Index>(essential_.size() + 1);
    Eigen::MatrixXd x = Eigen::MatrixXd::Identity(size, size);
    std::vector<double> workspace(essential_.size() + 1);
    x.applyHouseholderOnTheLeft(view_of(std::span<const double>(essential_)), factor_, workspace.data());
    return matrix_of(x.rightCols(size - 1));
}

}  // namespace gyrolog
