// Gap curves of a recording against those of simulations.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/gap_curves.hpp"

namespace gyrolog {

// What simulations give for every number of every curve.
struct GapReference {
    std::vector<std::vector<double>> mean;  // by curve, by point
    std::vector<std::vector<double>> sd;
    std::vector<double> rms_scale;  // by curve: root mean square, over simulations, of their own rms z
    // By curve: mean and variance of the sum of z^2 over the simulations.
    std::vector<double> square_mean, square_variance;
};

// `simulations`: at least ten, all from one baseline.
GapReference gap_reference(const std::vector<std::vector<GapCurve>>& simulations);

struct CurveDistance {
    std::vector<double> z;
    double distance = 0.0;  // rms of z in units of a simulation's: 1 is the floor
    // -ln of the probability that a simulation's curve is as far off in sum, or at one point; the larger.
    double surprise_nats = 0.0;
};

CurveDistance gap_of(const GapCurve& curve, const GapReference& reference, std::size_t index);

}  // namespace gyrolog
