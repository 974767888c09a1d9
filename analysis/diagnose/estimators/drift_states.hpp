// Drift states are a noise spectrum as a few independent first-order processes: what a Kalman filter needs of
// it.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace gyrolog {

namespace resolution {

inline constexpr std::size_t drift_parts = 4;

}  // namespace resolution

// The states are those of averages over `step_s`: white noise, a random walk (the last part), and
// Gauss-Markov processes with correlation times a factor of sixteen apart, the first twice the step. Together
// they follow flicker noise to a seventh (A. van der Ziel, Physica 16 (1950) 359).
struct DriftStates {
    double white_variance = 0.0;                               // of one average
    std::array<double, resolution::drift_parts> kept{};        // from one average to the next
    std::array<double, resolution::drift_parts> innovation{};  // variance
    std::array<double, resolution::drift_parts>
        start{};  // variance before the first; the random walk's is wide
};

// The function fits the states to `density`, two-sided, at f_hz, weighted alike in every octave up to 1 / (2
// step_s). The coefficients come by multiplicative updates of the Itakura-Saito distance (C. Fevotte, N.
// Bertin, J.-L. Durrieu, Neural Computation 21 (2009) 793), which is Whittle's likelihood.
DriftStates drift_states(std::span<const double> f_hz, std::span<const double> density, double step_s,
                         double duration_s);

}  // namespace gyrolog
