#include "analysis/denoise/riccati.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/lu.hpp"
#include "analysis/numerics/matrix_products.hpp"

namespace gyrolog {
namespace {

void add(Matrix& sum, const Matrix& matrix) {
    const std::span<double> values = sum.values();
    for (std::size_t i = 0; i < values.size(); ++i) { values[i] += matrix.values()[i]; }
}

void make_symmetric(Matrix& matrix) {
    for (std::size_t j = 0; j < matrix.columns(); ++j) {
        for (std::size_t i = 0; i <= j; ++i) {
            matrix(i, j) = matrix(j, i) = 0.5 * (matrix(i, j) + matrix(j, i));
        }
    }
}

double norm(const Matrix& matrix) { return std::sqrt(dot(matrix.values(), matrix.values())); }

}  // namespace

SteadyCovariance steady_covariance(const Matrix& F, const Matrix& H, const Matrix& Q, const Matrix& R) {
    constexpr int doublings_most = 60;
    constexpr double tolerance = 1e-13;
    SteadyCovariance steady;
    Matrix A = transposed(F);
    Matrix G = transposed_product(H, CholeskyFactor(R).solve(H));
    steady.covariance = Q;
    Matrix& X = steady.covariance;
    for (; steady.doublings < doublings_most && !steady.settled; ++steady.doublings) {
        Matrix both = product(G, X);
        add(both, Matrix::identity(F.rows()));
        const LuFactors W(both);
        const Matrix WA = W.solve(A);
        const Matrix growth = product(transposed_product(A, X), WA);
        add(G, transposed(product_with_transposed(A, product(A, W.solve(G)))));
        A = product(A, WA);
        add(X, growth);
        make_symmetric(X);
        make_symmetric(G);
        if (!std::ranges::all_of(X.values(), [](double value) { return std::isfinite(value); })) {
            return steady;
        }
        steady.settled = norm(growth) <= tolerance * norm(X);
    }
    return steady;
}

}  // namespace gyrolog
