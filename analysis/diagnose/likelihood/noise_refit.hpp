// A noise refit mends a model that was fitted to a recording with an effect: it holds part of the effect as
// noise, and with the effect in the model, too, a simulation has that part twice.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The function returns the axes on which less B or K than the model states, beyond its uncertainty, is called
// for, and those on which it states no N.
std::vector<std::size_t> axes_to_refit(const Observation& observation);

// The function returns the model with N, B and K of the axes as unknown as can be: what is fitted under it is
// fitted with them. What is stated as nothing a fit may have given to another coefficient: it begins at what
// is seen.
SensorModel with_free_noise(SensorModel model, const Observation& seen, const std::vector<std::size_t>& axes);

// The function returns the coefficients that an observation under a model with_free_noise() has, where
// `stated` has others.
std::vector<NoiseRefit> fitted_noise(const Observation& observation, const SensorModel& stated,
                                     const std::vector<std::size_t>& axes);
// The function puts the refits into the model.
SensorModel with_noise(SensorModel model, const std::vector<NoiseRefit>& noise);

}  // namespace gyrolog
