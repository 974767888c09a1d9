// A model fitted to a recording that has an effect holds part of the effect as noise: with the effect in the
// model, too, the simulation has it twice.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/observation.hpp"

namespace gyrolog {

// A noise coefficient of the model that the recording has otherwise, now that the causes are in the model. In
// SI units of the two-sided convention.
struct SwallowedNoise {
    std::size_t axis = 0;
    char coefficient = 'N';  // 'N', 'B', 'K'
    double stated = 0.0;
    double fitted = 0.0;
    double fitted_sd = 0.0;
};

// The axes on which less B or K than the model states, beyond its uncertainty, is called for.
std::vector<std::size_t> axes_with_swallowed_noise(const Observation& observation);

// N, B and K of the axes as unknown as can be: what is fitted under this model is fitted with them.
SensorModel with_free_noise(SensorModel model, const std::vector<std::size_t>& axes);

// What an observation under a model with_free_noise() has them at.
std::vector<SwallowedNoise> fitted_noise(const Observation& observation,
                                         const std::vector<std::size_t>& axes);
SensorModel with_noise(SensorModel model, const std::vector<SwallowedNoise>& noise);

}  // namespace gyrolog
