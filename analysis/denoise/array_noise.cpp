#include "analysis/denoise/array_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double slow_s = 1.0;
constexpr double least_walk = 1e-14;

}  // namespace

UnitNoise unit_noise(const NoiseModel& model, double rate_hz) {
    const NoiseCoefficients& c = model.coefficients;
    const double N2 = c.N_rad_per_sqrt_s * c.N_rad_per_sqrt_s;
    const double B2 = c.B_rad_per_s * c.B_rad_per_s;
    const double quantised = 2.0 * pi * c.Q_rad * rate_hz;
    UnitNoise noise;
    noise.white_variance =
        N2 * rate_hz + quantised * quantised * rate_hz / 12.0 + model.converter.density() * rate_hz;
    double walk = c.K_rad_per_s_sqrt_s * c.K_rad_per_s_sqrt_s;
    if (N2 > 0.0) { walk += B2 * B2 / N2; }
    for (const Sinusoid& line : model.sinusoids) {
        noise.white_variance += 0.5 * line.amplitude_rad_per_s * line.amplitude_rad_per_s;
    }
    for (const GaussMarkov& process : model.gauss_markov) {
        const double variance = process.sigma_rad_per_s * process.sigma_rad_per_s;
        if (process.correlation_s < slow_s) {
            noise.white_variance += variance;
        } else {
            walk += 2.0 * variance / process.correlation_s;
        }
    }
    noise.walk_variance = std::max(walk / rate_hz, least_walk * noise.white_variance);
    return noise;
}

std::vector<double> equal_correlation(std::size_t units, double correlation) {
    std::vector<double> matrix(units * units, correlation);
    for (std::size_t i = 0; i < units; ++i) { matrix[i * units + i] = 1.0; }
    return matrix;
}

std::vector<double> possible_correlation(std::vector<double> correlation, std::size_t units) {
    constexpr double least_eigenvalue = 1e-3;
    if (units == 0) { return correlation; }
    Matrix matrix(units, units);
    for (std::size_t i = 0; i < units; ++i) {
        for (std::size_t j = 0; j < units; ++j) { matrix(i, j) = correlation[i * units + j]; }
    }
    const double least = symmetric_eigenvalues(matrix).front();
    if (least >= least_eigenvalue) { return correlation; }
    // (1 - t) C + t I has the eigenvalues (1 - t) lambda + t.
    const double t = (least_eigenvalue - least) / (1.0 - least);
    for (double& value : correlation) { value *= 1.0 - t; }
    for (std::size_t i = 0; i < units; ++i) { correlation[i * units + i] += t; }
    return correlation;
}

std::vector<double> least_variance_weights(std::span<const double> covariance, std::size_t units) {
    const auto size = static_cast<Eigen::Index>(units);
    const Eigen::Map<const RowMajor> matrix(covariance.data(), size, size);
    const Eigen::LLT<RowMajor> factor(matrix);
    if (factor.info() != Eigen::Success) { return {}; }
    const Eigen::VectorXd share = factor.solve(Eigen::VectorXd::Ones(size));
    const double sum = share.sum();
    if (!(sum > 0.0) || !std::isfinite(sum)) { return {}; }
    std::vector<double> weights(units);
    for (std::size_t i = 0; i < units; ++i) { weights[i] = share[static_cast<Eigen::Index>(i)] / sum; }
    return weights;
}

}  // namespace gyrolog
