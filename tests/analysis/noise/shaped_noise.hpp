// White noise, flicker and random walk as the published comparison of methods makes them: flicker shaped in
// the frequency domain, from a series several times as long as the record.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog::test {

inline std::vector<double> shaped_noise(const NoiseCoefficients& noise, std::size_t samples, double rate_hz,
                                        std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::size_t length = 2;
    while (length < 4 * samples) { length *= 2; }
    std::vector<std::complex<double>> spectrum(length / 2 + 1);
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        // S(f) rate length / 2 a part, f = k rate / length.
        const double density = noise.B_rad_per_s * noise.B_rad_per_s * static_cast<double>(length) /
                               (2.0 * pi * static_cast<double>(k));
        const double part = std::sqrt(0.5 * density * static_cast<double>(length));
        spectrum[k] = {part * normal(random), part * normal(random)};
    }
    spectrum.back() = std::sqrt(2.0) * spectrum.back().real();
    Eigen::FFT<double> transform;
    transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<double> x;
    transform.inv(x, spectrum, static_cast<Eigen::Index>(length));
    x.resize(samples);
    double walk = 0.0;
    for (double& value : x) {
        walk += noise.K_rad_per_s_sqrt_s / std::sqrt(rate_hz) * normal(random);
        value += walk + noise.N_rad_per_sqrt_s * std::sqrt(rate_hz) * normal(random);
    }
    return x;
}

}  // namespace gyrolog::test
