// What is orthogonal to one direction, in coordinates of its own, one fewer than before, by Householder's
// reflection. Independent numbers of one variance stay so. Of the direction of equal numbers it is what is
// left without the mean.
#pragma once

#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

class OrthogonalComplement {
public:
    explicit OrthogonalComplement(std::span<const double> direction);  // not empty, not all 0

    std::vector<double> of(std::span<const double> vector) const;
    Matrix of_covariance(const Matrix& covariance) const;
    // The unit vectors of the coordinates, column by column.
    Matrix basis() const;

private:
    std::vector<double> essential_;  // of the reflection's vector, whose first element is 1
    double factor_ = 0.0;
};

}  // namespace gyrolog
