// Where a noise likelihood is largest, with no square negative; and how far one square can move from there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/noise/noise_likelihood.hpp"

namespace gyrolog {

struct LikelihoodMaximum {
    std::vector<double> squares;
    double value = 0.0;  // -inf: nowhere possible
};

// Fisher scoring with an active set, from `start`. Components in `held` (indices) keep their value.
LikelihoodMaximum maximise(const NoiseLikelihood& likelihood, std::span<const double> start,
                           std::span<const std::size_t> held = {});

struct SquareInterval {
    double lo = 0.0;
    double hi = 0.0;
};

// Where twice the drop of the log likelihood, all others refitted, reaches `sigmas`^2 (Wilks): unlike value
// and standard deviation it knows that a square ends at 0 and that its scatter grows with it. `sd`: of that
// square, a first guess.
SquareInterval profile_interval(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                                std::size_t component, double sigmas, double sd);

// Twice the gain of the log likelihood by this component.
double likelihood_ratio(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                        std::size_t component);

}  // namespace gyrolog
