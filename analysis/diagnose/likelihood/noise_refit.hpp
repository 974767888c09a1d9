// A model fitted to a recording that has an effect holds part of the effect as noise: with the effect in the
// model, too, the simulation has it twice.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The axes on which less B or K than the model states, beyond its uncertainty, is called for, and those on
// which it states no N.
std::vector<std::size_t> axes_to_refit(const Observation& observation);

// The model with N, B and K of the axes as unknown as can be: what is fitted under it is fitted with them.
// What is stated as nothing a fit may have given to another coefficient: it begins at what is seen.
SensorModel with_free_noise(SensorModel model, const Observation& seen, const std::vector<std::size_t>& axes);

// What an observation under a model with_free_noise() has them at, where `stated` has others.
std::vector<NoiseRefit> fitted_noise(const Observation& observation, const SensorModel& stated,
                                     const std::vector<std::size_t>& axes);
SensorModel with_noise(SensorModel model, const std::vector<NoiseRefit>& noise);

}  // namespace gyrolog
