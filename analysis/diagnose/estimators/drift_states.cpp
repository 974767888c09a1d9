#include "analysis/diagnose/estimators/drift_states.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog::resolution {

constexpr double part_spacing = 16.0;
constexpr int amount_rounds = 60;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

constexpr std::size_t terms = resolution::drift_parts + 1;  // white noise is the last

struct DensityPlace {
    double weight = 0.0;
    double density = 0.0;
    std::array<double, terms> unit{};
};

double correlation_s(std::size_t part, double step_s) {
    return 2.0 * step_s * std::pow(resolution::part_spacing, static_cast<double>(part));
}

// Densities of processes of variance 1; of a random walk that grows by 1 a second; of white noise of
// density 1.
std::array<double, terms> unit_densities(double f_hz, double step_s) {
    std::array<double, terms> unit{};
    const double omega = 2.0 * pi * f_hz;
    for (std::size_t part = 0; part + 1 < resolution::drift_parts; ++part) {
        unit[part] = GaussMarkov{1.0, correlation_s(part, step_s)}.psd(f_hz);
    }
    unit[resolution::drift_parts - 1] = 1.0 / (omega * omega);
    unit[resolution::drift_parts] = 1.0;
    return unit;
}

std::array<double, terms> fitted_amounts(const std::vector<DensityPlace>& places) {
    std::array<double, terms> amount{};
    // Each at first alone.
    for (std::size_t j = 0; j < terms; ++j) {
        double least = 1e300;
        for (const DensityPlace& place : places) { least = std::min(least, place.density / place.unit[j]); }
        amount[j] = least;
    }
    for (int round = 0; round < resolution::amount_rounds; ++round) {
        std::array<double, terms> up{};
        std::array<double, terms> down{};
        for (const DensityPlace& place : places) {
            double model = 0.0;
            for (std::size_t j = 0; j < terms; ++j) { model += amount[j] * place.unit[j]; }
            for (std::size_t j = 0; j < terms; ++j) {
                const double share = place.weight * place.unit[j] / model;
                up[j] += share * place.density / model;
                down[j] += share;
            }
        }
        for (std::size_t j = 0; j < terms; ++j) { amount[j] *= up[j] / down[j]; }
    }
    return amount;
}

}  // namespace

DriftStates drift_states(std::span<const double> f_hz, std::span<const double> density, double step_s,
                         double duration_s) {
    std::vector<DensityPlace> places;
    for (std::size_t i = 0; i < f_hz.size() && f_hz[i] < 0.5 / step_s; ++i) {
        const double next = i + 1 < f_hz.size() ? f_hz[i + 1] : f_hz[i];
        const double octaves = std::log2(next / f_hz[i]);
        places.push_back({octaves, density[i], unit_densities(f_hz[i], step_s)});
    }
    DriftStates states;
    if (places.empty()) { return states; }
    const std::array<double, terms> amount = fitted_amounts(places);
    const double walk = amount[resolution::drift_parts - 1];
    double variance = walk * duration_s;
    for (std::size_t part = 0; part + 1 < resolution::drift_parts; ++part) {
        states.kept[part] = std::exp(-step_s / correlation_s(part, step_s));
        states.start[part] = amount[part];
        states.innovation[part] = amount[part] * (1.0 - states.kept[part] * states.kept[part]);
        variance += amount[part];
    }
    states.white_variance = amount[resolution::drift_parts] / step_s;
    // The mean is not known.
    states.kept.back() = 1.0;
    states.innovation.back() = walk * step_s;
    states.start.back() = 100.0 * (variance + states.white_variance);
    return states;
}

}  // namespace gyrolog
