// The white distribution is that of an axis' white noise by the prediction's model.
#pragma once

#include <cstddef>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/likelihood/whitened_blocks.hpp"
#include "analysis/numerics/normal_mixture.hpp"

namespace gyrolog {

// The degrees of freedom of Student's t; infinity: normal. Of several entries the last one rules, as it does
// in the simulator.
double white_degrees_of_freedom(const Prediction& prediction, std::size_t axis);

// The distribution of a whitened sample whose white noise has `nu` degrees of freedom.
NormalMixture whitened_mixture(const Prediction& prediction, std::size_t axis, double nu);

struct ScaledFit {
    double log_likelihood_nats = 0.0;
    double scale = 1.0;
};

// The function finds the scale at which the samples fit the distribution best. `start`: where to begin.
ScaledFit fit_scale(const WhitenedHistogram& histogram, const LogDensityTable& log_density, double start);

}  // namespace gyrolog
