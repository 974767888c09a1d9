// Allan curves of known models, as they are read off a printed page.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "analysis/noise/curve_model.hpp"

namespace gyrolog::test {

// Sixty averaging times over six decades.
inline constexpr int print_points = 60;
inline constexpr double print_first_s = 0.01;
inline constexpr double print_last_s = 1e4;

struct Reading {
    double error = 0.0;      // relative, independent
    double smooth_db = 0.0;  // standard deviation of what neighbours share, over an octave
    std::uint64_t seed = 1;
};

inline AllanCurve curve_of(const NoiseModel& model, const Reading& reading = {}) {
    std::mt19937_64 generator(reading.seed);
    std::normal_distribution<double> normal;
    const double ratio = std::pow(print_last_s / print_first_s, 1.0 / (print_points - 1));
    const double memory = std::exp(-std::log2(ratio));
    double smooth = normal(generator);
    AllanCurve curve;
    for (int i = 0; i < print_points; ++i) {
        AllanPoint point;
        point.tau_s = print_first_s * std::pow(ratio, i);
        const double error_db =
            20.0 / std::log(10.0) * reading.error * normal(generator) + reading.smooth_db * smooth;
        point.deviation = std::sqrt(model.allan_variance(point.tau_s)) * std::pow(10.0, error_db / 20.0);
        smooth = memory * smooth + std::sqrt(1.0 - memory * memory) * normal(generator);
        curve.points.push_back(point);
    }
    return curve;
}

inline NoiseModel nbk() {
    NoiseModel model;
    model.coefficients = {0.0, 0.01, 0.002, 1e-4, 0.0};
    return model;
}

inline NoiseModel all_five() {
    NoiseModel model;
    model.coefficients = {5e-4, 0.01, 0.002, 1e-4, 2e-6};
    return model;
}

inline NoiseModel with_gauss_markov() {
    NoiseModel model;
    model.coefficients = {0.0, 0.01, 0.0, 1e-4, 0.0};
    model.gauss_markov = {{0.004, 20.0}};
    return model;
}

inline NoiseModel with_sinusoid() {
    NoiseModel model = nbk();
    model.sinusoids = {{0.006, 0.05}};
    return model;
}

inline std::string kinds_of(const std::vector<CurveTerm>& terms) {
    std::string kinds;
    for (const CurveTerm& term : terms) {
        kinds += std::string(kinds.empty() ? "" : " ") + std::string(name_of(term.kind));
    }
    return kinds;
}

}  // namespace gyrolog::test
