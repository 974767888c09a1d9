// Noise of a sensor with known N, B and K, made the plain way: an oracle for the fits, not the project's
// simulator.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog::test {

// Flicker is a sum of first-order processes with corner frequencies an octave apart: with variance B^2 ln 2 /
// pi each, their spectra add up to B^2 / (2 pi f), within 0.1 % between the outermost corners.
inline std::vector<double> sensor_noise(const NoiseCoefficients& noise, std::size_t samples, double rate_hz,
                                        std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> x(samples);
    const double duration_s = static_cast<double>(samples) / rate_hz;
    double walk = 0.0;
    for (double& value : x) {
        value = noise.N_rad_per_sqrt_s * std::sqrt(rate_hz) * normal(random) + walk;
        walk += noise.K_rad_per_s_sqrt_s / std::sqrt(rate_hz) * normal(random);
    }
    if (noise.B_rad_per_s == 0.0) { return x; }
    const double sd = noise.B_rad_per_s * std::sqrt(std::log(2.0) / pi);
    for (double corner = 2.0 * pi / (30.0 * duration_s); corner < 4.0 * rate_hz; corner *= 2.0) {
        const double kept = std::exp(-corner / rate_hz);
        const double added = sd * std::sqrt(1.0 - kept * kept);
        double state = sd * normal(random);
        for (double& value : x) {
            value += state;
            state = kept * state + added * normal(random);
        }
    }
    return x;
}

}  // namespace gyrolog::test
