// A noise model put into the few terms that another simulator has: white noise, with a bias that walks or is
// a first-order Gauss-Markov process. The coefficients are those whose Allan deviation is nearest to the
// model's from one sample to a horizon: the largest error in dB, 20 |log10(deviation / model's)|, is as small
// as it can be (over averaging times that are 1/16 of an octave apart).
#pragma once

#include <span>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

enum class ProjectedTerms {
    white,               // N
    white_walk,          // N and a rate random walk K
    white_gauss_markov,  // N and a Gauss-Markov process
};

// Of the ranges that are searched, 1 being all. The least error is a kink, not a parabola: what a place is
// off, the error is off.
struct ProjectionOptions {
    double log_odds_tolerance_rel = 1e-7;         // of 80 nats between the two terms' shares: 4e-5 dB
    double log_correlation_tolerance_rel = 1e-4;  // of two steps of the net of correlation times
};

struct NoiseProjection {
    double N_rad_per_sqrt_s = 0.0;
    double K_rad_per_s_sqrt_s = 0.0;  // of the walk
    GaussMarkov gauss_markov{};       // sigma 0: none

    double worst_dB = 0.0;  // infinite of noise that was put into no noise
    double worst_tau_s = 0.0;

    // sqrt(2 / T) sigma: the density by which the process is driven, of which simulators make it.
    double drive_rad_per_s_sqrt_s() const;
    double allan_variance(double tau_s) const;  // (rad/s)^2
};

// One projection for all models: of a simulator that has one number for all axes, the error is that of the
// axis where it is largest. What the terms have already is given back as it is. `rate_hz` and `horizon_s` are
// above zero, the horizon not below one sample.
NoiseProjection project_noise(std::span<const NoiseModel> models, ProjectedTerms terms, double rate_hz,
                              double horizon_s, const ProjectionOptions& options = {});

}  // namespace gyrolog
