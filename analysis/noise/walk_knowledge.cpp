#include "analysis/noise/walk_knowledge.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "analysis/allan/difference_covariance.hpp"

namespace gyrolog {
namespace {

constexpr double longest_s = 3.2e11;  // ten thousand years

// Of N^2, B^2 and K^2, in units of N^2, N W and W^2, W being a walk of about the record's size: the matrix is
// then well scaled whatever the units.
Eigen::Matrix3d covariance_of_squares(const NoiseCoefficients& noise, double W, double rate_hz,
                                      double length_s) {
    const double N = noise.N_rad_per_sqrt_s;
    const double B = noise.B_rad_per_s;
    const double K = noise.K_rad_per_s_sqrt_s;
    const Eigen::Vector3d squares(N * N, B * B, K * K);
    const Eigen::Vector3d unit(N * N, N * W, W * W);
    constexpr double step = 1.02;
    const double half = std::sqrt(step);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    const int steps = static_cast<int>(std::log(rate_hz * length_s) / std::log(step));
    for (int i = 0; i < steps; ++i) {
        const double f_hz = 0.5 / length_s * std::pow(step, i) * half;  // the middle of the step
        const double angular = 2.0 * rate_hz * std::sin(pi * f_hz / rate_hz);
        const Eigen::Vector3d spectra(1.0, 1.0 / angular, 1.0 / (angular * angular));
        const Eigen::Vector3d relative = spectra.cwiseProduct(unit) / spectra.dot(squares);
        information += length_s * f_hz * (half - 1.0 / half) * relative * relative.transpose();
    }
    return information.inverse();
}

bool has_bound(const NoiseCoefficients& noise, double rate_hz, double length_s) {
    return noise.N_rad_per_sqrt_s > 0.0 && rate_hz * length_s >= 10.0;
}

std::optional<double> root_of_half(double variance) {
    if (!(variance > 0.0) || !std::isfinite(variance)) { return std::nullopt; }
    return std::sqrt(variance) / 2.0;
}

// Of the relative standard deviation at a length, which falls with it.
template <typename RelativeSd>
std::optional<double> length_to_know_s(double rate_hz, double relative_sd, const RelativeSd& sd_at) {
    const auto known = [&](double length_s) {
        const std::optional<double> sd = sd_at(length_s);
        return sd && *sd <= relative_sd;
    };
    if (!(rate_hz > 0.0) || !known(longest_s)) { return std::nullopt; }
    double below_s = 10.0 / rate_hz;
    double above_s = longest_s;
    while (above_s > 1.001 * below_s) {
        const double middle_s = std::sqrt(below_s * above_s);
        (known(middle_s) ? above_s : below_s) = middle_s;
    }
    return above_s;
}

}  // namespace

std::optional<double> walk_relative_sd(const NoiseCoefficients& noise, double rate_hz, double length_s) {
    const double K = noise.K_rad_per_s_sqrt_s;
    if (!(K > 0.0) || !has_bound(noise, rate_hz, length_s)) { return std::nullopt; }
    return root_of_half(covariance_of_squares(noise, K, rate_hz, length_s)(2, 2));
}

std::optional<double> flicker_relative_sd(const NoiseCoefficients& noise, double rate_hz, double length_s) {
    const double N = noise.N_rad_per_sqrt_s;
    const double B = noise.B_rad_per_s;
    if (!(B > 0.0) || !has_bound(noise, rate_hz, length_s)) { return std::nullopt; }
    const double W = B * B / N;
    return root_of_half(covariance_of_squares(noise, W, rate_hz, length_s)(1, 1));
}

std::optional<double> length_to_know_walk_s(const NoiseCoefficients& noise, double rate_hz,
                                            double relative_sd) {
    return length_to_know_s(rate_hz, relative_sd,
                            [&](double length_s) { return walk_relative_sd(noise, rate_hz, length_s); });
}

std::optional<double> length_to_know_flicker_s(const NoiseCoefficients& noise, double rate_hz,
                                               double relative_sd) {
    return length_to_know_s(rate_hz, relative_sd,
                            [&](double length_s) { return flicker_relative_sd(noise, rate_hz, length_s); });
}

std::optional<double> walk_seen_from(const NoiseCoefficients& noise, double rate_hz, double length_s) {
    constexpr double seen_sd = 0.22;
    const double N = noise.N_rad_per_sqrt_s;
    if (!(N > 0.0) || !(rate_hz * length_s >= 10.0)) { return std::nullopt; }
    NoiseCoefficients walked = noise;
    // Between a walk that is lost below the white noise and one that is all there is.
    double below = 1e-6 * N / length_s;
    double above = N * rate_hz;
    while (above > 1.001 * below) {
        walked.K_rad_per_s_sqrt_s = std::sqrt(below * above);
        const auto sd = walk_relative_sd(walked, rate_hz, length_s);
        (sd && *sd <= seen_sd ? above : below) = walked.K_rad_per_s_sqrt_s;
    }
    return above;
}

NoiseCoefficients coefficients_of(const PowerLawLevels& laws, double rate_hz) {
    // Where averages of samples are as those of continuous noise (METHODS.md, N, K, Q, R).
    constexpr std::int64_t long_m = 1024;
    const DeviationRule& rule = rule_of(DeviationKind::overlapping);
    const auto variance = [&](PowerLaw law, std::int64_t m) {
        return laws.level[index_of(law)] * DifferenceCovariance(law, rule, m).expected_variance();
    };
    const double long_tau_s = static_cast<double>(long_m) / rate_hz;
    NoiseCoefficients noise;
    noise.N_rad_per_sqrt_s = std::sqrt(variance(PowerLaw::white_rate, 1) / rate_hz);
    noise.B_rad_per_s = std::sqrt(variance(PowerLaw::flicker_rate, long_m) * pi / (2.0 * std::log(2.0)));
    noise.K_rad_per_s_sqrt_s = std::sqrt(variance(PowerLaw::rate_walk, long_m) * 3.0 / long_tau_s);
    return noise;
}

}  // namespace gyrolog
