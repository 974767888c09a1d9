// Samples of gyro arrays whose noise is exactly the filter's model.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <vector>

#include "analysis/denoise/array_noise.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

using Signal = std::vector<double>;        // a sample each
using ArraySamples = std::vector<Signal>;  // a signal each unit

inline ArrayNoise equal_units(std::size_t units, double white_sd, double walk_sd, double rate_hz = 200.0) {
    ArrayNoise noise;
    noise.rate_hz = rate_hz;
    noise.units.assign(units, {white_sd * white_sd, walk_sd * walk_sd});
    return noise;
}

// Rows are units; correlated by the Cholesky factor of `correlation`.
inline ArraySamples correlated_normals(std::size_t units, std::size_t samples, std::uint64_t seed,
                                       std::uint32_t stream, const std::vector<double>& correlation) {
    ArraySamples normals(units, Signal(samples));
    for (std::size_t i = 0; i < units; ++i) {
        RandomStream(seed, stream + static_cast<std::uint32_t>(i)).normals(0, normals[i]);
    }
    if (correlation.empty()) { return normals; }
    const auto size = static_cast<Eigen::Index>(units);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::MatrixXd matrix = Eigen::Map<const RowMajor>(correlation.data(), size, size);
    const Eigen::MatrixXd L = matrix.llt().matrixL();
    for (std::size_t k = 0; k < samples; ++k) {
        Eigen::VectorXd independent(size);
        for (std::size_t i = 0; i < units; ++i) { independent[static_cast<Eigen::Index>(i)] = normals[i][k]; }
        const Eigen::VectorXd mixed = L * independent;
        for (std::size_t i = 0; i < units; ++i) { normals[i][k] = mixed[static_cast<Eigen::Index>(i)]; }
    }
    return normals;
}

// rate + bias walk + white noise.
inline ArraySamples array_samples(const ArrayNoise& noise, const Signal& rate, std::uint64_t seed) {
    const std::size_t units = noise.units.size();
    ArraySamples samples = correlated_normals(units, rate.size(), seed, 0, noise.white_correlation);
    const ArraySamples steps = correlated_normals(units, rate.size(), seed, 100, noise.walk_correlation);
    for (std::size_t i = 0; i < units; ++i) {
        double bias = 0.0;
        for (std::size_t k = 0; k < rate.size(); ++k) {
            samples[i][k] = rate[k] + bias + samples[i][k] * std::sqrt(noise.units[i].white_variance);
            bias += steps[i][k] * std::sqrt(noise.units[i].walk_variance);
        }
    }
    return samples;
}

inline Signal at(const ArraySamples& samples, std::size_t k) {
    Signal one;
    one.reserve(samples.size());
    for (const Signal& unit : samples) { one.push_back(unit[k]); }
    return one;
}

inline double mean_of(const Signal& x, std::size_t from = 0) {
    double sum = 0.0;
    for (std::size_t k = from; k < x.size(); ++k) { sum += x[k]; }
    return sum / static_cast<double>(x.size() - from);
}

inline double variance_of(const Signal& x, std::size_t from = 0) {
    const double mean = mean_of(x, from);
    double squares = 0.0;
    for (std::size_t k = from; k < x.size(); ++k) { squares += (x[k] - mean) * (x[k] - mean); }
    return squares / static_cast<double>(x.size() - from - 1);
}

}  // namespace gyrolog
