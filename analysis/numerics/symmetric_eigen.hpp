// Eigenvalues and eigenvectors of a symmetric matrix. Only the lower half is read.
#pragma once

#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

struct SymmetricEigen {
    std::vector<double> values;  // rising
    Matrix vectors;              // column by column, of length one
};

SymmetricEigen symmetric_eigen(const Matrix& symmetric);
std::vector<double> symmetric_eigenvalues(const Matrix& symmetric);  // rising

}  // namespace gyrolog
