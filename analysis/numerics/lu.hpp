// Equations with any square matrix that has an inverse, by its triangular factors with pivots.
#pragma once

#include <memory>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// P A = L U. Of a matrix without inverse the solutions are not finite, or arbitrary.
class LuFactors {
public:
    explicit LuFactors(const Matrix& square);
    ~LuFactors();
    LuFactors(const LuFactors&) = delete;
    LuFactors& operator=(const LuFactors&) = delete;

    // A^-1 right
    Matrix solve(const Matrix& right) const;

private:
    struct Factors;
    std::unique_ptr<Factors> factors_;
};

}  // namespace gyrolog
